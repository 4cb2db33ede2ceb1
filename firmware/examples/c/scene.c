// A scene of 64 ticks: a robot is carried past a target that moves north and turns left the while, hears of obstacles
// from a neighbour, and comes close to something on its left. All in integers, so that every machine sees the same;
// firmware/c/tests/scene.rs has it once more, in Rust.
#include "scene.h"

#include "grn.h"

enum { TICKS = 64, ROBOT = 3, NEIGHBOUR = 7 };

// What the robot perceives in a tick.
static void perceive(int tick, GrnPercept *percept) {
    *percept = (GrnPercept)GRN_PERCEPT_NOTHING;
    // At 100 mm/s to the east, 0.3 m south of the origin.
    percept->has_fix = 1;
    percept->fix.position[0] = -400000 + 3125 * tick;
    percept->fix.position[1] = -300000;
    // First to the east, then a sixteenth of a radian further to the left in each tick.
    int32_t cos = 1 << 14, sin = 0;
    for (int turn = 0; turn < tick; turn++) {
        cos -= sin / 16;
        sin += cos / 16;
    }
    percept->fix.heading[0] = (int16_t)cos;
    percept->fix.heading[1] = (int16_t)sin;
    if (tick >= 48) percept->proximity[5] = (uint16_t)(400 - 10 * (tick - 48));  // 90 degrees left
    if (tick % 8 == 0) {
        percept->target_count = 1;
        percept->targets[0] = (GrnSighting){.target = 1, .position = {.x = 100, .y = (int16_t)(2 * tick)}};
    }
    if (tick % 4 == 1) {
        percept->heard_count = 1;
        GrnMessage *message = &percept->heard[0].message;
        message->sender = NEIGHBOUR;
        message->position = (GrnMillimetres){.x = (int16_t)(3 * tick), .y = -250};
        message->has_target = tick > 16;
        message->target = (GrnTargetReport){
            .target = 2, .position = {.x = -600, .y = 500}, .velocity = {0, -40}, .age = 12};
        message->obstacle_count = 2;
        message->obstacles[0] = (GrnObstacleReport){.position = {.x = 150, .y = -350}, .age = 1};
        message->obstacles[1] = (GrnObstacleReport){.position = {.x = 200, .y = (int16_t)(-350 - tick)}, .age = 0};
    }
}

// Small printers, because a robot has no printf.

static void (*out)(const char *text);

static void print_integer(int32_t value) {
    char digits[12];
    char *digit = &digits[11];
    uint32_t rest = value < 0 ? 0u - (uint32_t)value : (uint32_t)value;
    *digit = 0;
    do *--digit = (char)('0' + rest % 10);
    while (rest /= 10);
    if (value < 0) *--digit = '-';
    out(digit);
}

static void print_hex(uint32_t value, int digits) {
    char text[9];
    for (int i = 0; i < digits; i++) text[i] = "0123456789abcdef"[value >> 4 * (digits - 1 - i) & 15];
    text[digits] = 0;
    out(text);
}

static void print_number(int32_t value) {
    out(" ");
    print_integer(value);
}

static void print_position(GrnMillimetres position) {
    print_number(position.x);
    print_number(position.y);
}

static void print_command(const GrnCommand *command) {
    print_number(command->left);
    print_number(command->right);
    if (!command->has_broadcast) return;
    const GrnMessage *message = &command->broadcast;
    out(" says");
    print_number(message->sender);
    print_position(message->position);
    if (message->has_target) {
        out(" target");
        print_number(message->target.target);
        print_position(message->target.position);
        print_number(message->target.velocity[0]);
        print_number(message->target.velocity[1]);
        print_number(message->target.age);
    }
    for (int i = 0; i < message->obstacle_count; i++) {
        out(" obstacle");
        print_position(message->obstacles[i].position);
        print_number(message->obstacles[i].age);
    }
}

static int failed(GrnStatus status) {
    if (status == GRN_STATUS_OK) return 0;
    out(grn_status_text(status));
    out("\n");
    return 1;
}

// One line a tick: the tick, the bits of M as a float, the wheels, and what is broadcast.
static int play(const uint8_t *blob, size_t length, GrnNumber number) {
    static GrnController controller;
    static GrnPercept percept;
    if (failed(grn_load(&controller, sizeof controller, blob, length, number, ROBOT))) return 1;
    uint8_t identity[GRN_IDENTITY_BYTES];
    if (failed(grn_identity(&controller, identity))) return 1;
    out(number == GRN_NUMBER_F32 ? "f32" : "q8.24");
    out(" ");
    for (int i = 0; i < GRN_IDENTITY_BYTES; i++) print_hex(identity[i], 2);
    out("\n");
    for (int tick = 0; tick < TICKS; tick++) {
        GrnCommand command;
        union {
            float value;
            uint32_t bits;
        } morphogen;
        perceive(tick, &percept);
        if (failed(grn_tick(&controller, &percept, &command))) return 1;
        if (failed(grn_morphogen(&controller, &morphogen.value))) return 1;
        print_integer(tick);
        out(" ");
        print_hex(morphogen.bits, 8);
        print_command(&command);
        out("\n");
    }
    return 0;
}

int scene(const uint8_t *blob, size_t length, void (*print)(const char *text)) {
    out = print;
    return play(blob, length, GRN_NUMBER_F32) || play(blob, length, GRN_NUMBER_Q8_24);
}
