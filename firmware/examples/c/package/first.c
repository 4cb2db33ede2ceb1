// A first program against an installed grn, in C and in C++: a robot that sees a target drives towards it.
//
//     cc first.c $(pkg-config --cflags --libs grn) -o first && ./first nand-xnor.grn
#include <grn.h>
#include <stdio.h>
#include <string.h>

static GrnController controller;
static uint8_t blob[1024];

static int check(GrnStatus status) {
    if (status != GRN_STATUS_OK) fprintf(stderr, "%s\n", grn_status_text(status));
    return status == GRN_STATUS_OK;
}

// The macro and the function give the same percept.
static int nothing_is_nothing(void) {
    GrnPercept macro = GRN_PERCEPT_NOTHING, function;
    return check(grn_percept_nothing(&function)) && memcmp(&macro, &function, sizeof macro) == 0;
}

// What a robot says arrives over a radio with payloads of 8 bytes. Each message has a number of its own.
static int message_arrives(const GrnMessage *said, uint32_t tick) {
    static GrnAssembler assembler;
    static uint8_t number;
    GrnMessage heard;
    size_t index, length = 1;
    number++;
    for (index = 0; length > 0; index++) {
        uint8_t fragment[8];
        if (!check(grn_message_fragment(said, number, sizeof fragment, index, fragment, &length))) return 0;
        if (grn_assembler_receive(&assembler, sizeof assembler, tick, fragment, length, &heard) == GRN_STATUS_OK) {
            return memcmp(said, &heard, sizeof heard) == 0;
        }
    }
    return 0;
}

int main(int argc, char **argv) {
    GrnCommand command;
    uint32_t tick;
    int said = 0;
    size_t length;
    FILE *file = argc == 2 ? fopen(argv[1], "rb") : NULL;
    if (!file) {
        fprintf(stderr, "usage: first BLOB\n");
        return 2;
    }
    length = fread(blob, 1, sizeof blob, file);
    fclose(file);
    if (strcmp(grn_version(), GRN_VERSION_STRING) != 0) {
        fprintf(stderr, "the header is of version %s, the library of %s\n", GRN_VERSION_STRING, grn_version());
        return 1;
    }
    if (!check(grn_load(&controller, sizeof controller, blob, length, GRN_NUMBER_F32, 1))) return 1;
    for (tick = 0; tick < GRN_TICKS_PER_SECOND; tick++) {
        GrnPercept percept = GRN_PERCEPT_NOTHING;
        percept.has_fix = 1;
        percept.fix.heading[0] = 16384;  // at the origin, looking east
        percept.target_count = 1;
        percept.targets[0].position.x = 900;
        if (!check(grn_tick(&controller, &percept, &command))) return 1;
        if (command.has_broadcast) said += message_arrives(&command.broadcast, tick);
    }
    printf("grn %s: wheels %d %d, %d messages, nothing is nothing: %d\n", grn_version(), command.left, command.right, said,
           nothing_is_nothing());
    return 0;
}
