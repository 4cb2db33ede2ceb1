// Declarations of what the controller calls, for compiling where Webots is absent. Webots' own header has the same.
#pragma once
#include <webots/types.h>
void wb_receiver_enable(WbDeviceTag tag, int sampling_period);
int wb_receiver_get_queue_length(WbDeviceTag tag);
void wb_receiver_next_packet(WbDeviceTag tag);
const void *wb_receiver_get_data(WbDeviceTag tag);
int wb_receiver_get_data_size(WbDeviceTag tag);
double wb_receiver_get_signal_strength(WbDeviceTag tag);
