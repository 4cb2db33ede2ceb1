// Declarations of what the controller calls, for compiling where Webots is absent. Webots' own header has the same.
#pragma once
#include <webots/types.h>
int wb_emitter_send(WbDeviceTag tag, const void *data, int size);
