// The same short scene for every machine: see scene.c.
#ifndef SCENE_H
#define SCENE_H

#include <stddef.h>
#include <stdint.h>

// Prints what a robot with this blob does in the scene, in both number types, one line a tick; a line is given to
// `print` in pieces, each a string. Returns 0, or 1 after printing what went wrong.
int scene(const uint8_t *blob, size_t length, void (*print)(const char *text));

#endif
