// Declarations of what the controller calls, for compiling where Webots is absent. Webots' own header has the same.
#pragma once
#include <webots/types.h>
void wb_motor_set_position(WbDeviceTag tag, double position);
void wb_motor_set_velocity(WbDeviceTag tag, double velocity);
