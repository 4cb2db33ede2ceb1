// Declarations of what the controller calls, for compiling where Webots is absent. Webots' own header has the same.
#pragma once
#include <webots/types.h>
WbNodeRef wb_supervisor_node_get_from_def(const char *def);
const double *wb_supervisor_node_get_position(WbNodeRef node);
