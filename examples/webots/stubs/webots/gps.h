// Declarations of what the controller calls, for compiling where Webots is absent. Webots' own header has the same.
#pragma once
#include <webots/types.h>
void wb_gps_enable(WbDeviceTag tag, int sampling_period);
const double *wb_gps_get_values(WbDeviceTag tag);
