// Declarations of what the controller calls, for compiling where Webots is absent. Webots' own header has the same.
#pragma once
#include <stdint.h>
typedef uint16_t WbDeviceTag;
typedef struct WbNodeStructPrivate *WbNodeRef;
