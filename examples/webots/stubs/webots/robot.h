// Declarations of what the controller calls, for compiling where Webots is absent. Webots' own header has the same.
#pragma once
#include <webots/types.h>
int wb_robot_init(void);
int wb_robot_step(int duration);
void wb_robot_cleanup(void);
double wb_robot_get_time(void);
double wb_robot_get_basic_time_step(void);
WbDeviceTag wb_robot_get_device(const char *name);
