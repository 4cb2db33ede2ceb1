// The controller on a workstation: reads a blob from a file and plays the scene with it.
//
//     host ../../../models/nand-xnor.grn
#include <stdio.h>

#include "scene.h"

static void print(const char *text) { fputs(text, stdout); }

int main(int argc, char **argv) {
    if (argc != 2) {
        fprintf(stderr, "usage: %s BLOB\n", argv[0]);
        return 2;
    }
    FILE *file = fopen(argv[1], "rb");
    if (!file) {
        perror(argv[1]);
        return 2;
    }
    static uint8_t blob[1024];  // one of 32 genes takes 400 bytes
    size_t length = fread(blob, 1, sizeof blob, file);
    fclose(file);
    return scene(blob, length, print);
}
