// Declarations of what the controller calls, for compiling where Webots is absent. Webots' own header has the same.
#pragma once
#include <webots/types.h>
void wb_distance_sensor_enable(WbDeviceTag tag, int sampling_period);
double wb_distance_sensor_get_value(WbDeviceTag tag);
