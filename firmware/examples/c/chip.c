// The controller on a bare Cortex-M4F, here QEMU's STM32F405 board: start-up, output by semihosting, and the scene.
// The blob is part of the image. What the scene prints goes to standard output, what it took of the stack to standard
// error.
#include "grn.h"
#include "scene.h"

// A program that fills the RAM still has room for the controller in the memory beside the core (`make chip-ccm`). Nobody
// zeroes that memory at the start, which does no harm: grn_load writes all that grn_tick reads.
#ifndef CONTROLLER_PLACE
#define CONTROLLER_PLACE
#endif
#ifdef OTHER_VARIABLES
static volatile uint8_t other_variables[OTHER_VARIABLES];
#endif

// The blob, in flash.
__asm__(
    ".section .rodata\n"
    ".global blob, blob_end\n"
    "blob: .incbin \"" BLOB "\"\n"
    "blob_end:\n"
    ".text\n");
extern const uint8_t blob[], blob_end[];

// Semihosting: the debugger, or QEMU, does what a robot has no devices for.
enum { SYS_OPEN = 0x01, SYS_WRITE = 0x05, SYS_EXIT_EXTENDED = 0x20 };
enum { WRITE = 4, APPEND = 8 };  // of the console ":tt": standard output, standard error

static int semihosting(int operation, const void *argument) {
    register int r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xab" : "+r"(r0) : "r"(r1) : "memory");
    return r0;
}

static int console(int mode) { return semihosting(SYS_OPEN, (const uintptr_t[]){(uintptr_t) ":tt", (uintptr_t)mode, 3}); }

static int handle;

static void print(const char *text) {
    size_t length = 0;
    while (text[length]) length++;
    semihosting(SYS_WRITE, (const uintptr_t[]){(uintptr_t)handle, (uintptr_t)text, length});
}

// How much of the stack was used: below the stack pointer it is painted, and what is not that colour any more was used.
extern uint32_t stack_bottom[], stack_top[];
enum { PAINT = 0x5aa55aa5 };

static void paint_stack(void) {
    uint32_t *here = __builtin_frame_address(0);
    for (uint32_t *word = stack_bottom; word < here - 16; word++) *word = PAINT;
}

static uint32_t used_stack(void) {
    uint32_t *word = stack_bottom;
    while (*word == PAINT) word++;
    return (uint32_t)((uint8_t *)stack_top - (uint8_t *)word);
}

static void print_bytes(const char *what, uint32_t number) {
    char digits[12] = "          \n";
    for (char *digit = &digits[9]; number; number /= 10) *digit-- = (char)('0' + number % 10);
    print(what);
    print(digits);
}

static void measure_stack(GrnNumber number, const char *name) {
    static GrnController controller CONTROLLER_PLACE;
    static GrnCommand command;
    static GrnPercept percept = GRN_PERCEPT_NOTHING;
    percept.has_fix = 1;
    percept.fix.heading[0] = 16384;
    percept.target_count = percept.obstacle_count = percept.heard_count = 1;
    paint_stack();
    grn_load(&controller, sizeof controller, blob, (size_t)(blob_end - blob), number, 0);
    uint32_t load = used_stack();
    paint_stack();
    grn_tick(&controller, &percept, &command);
    uint32_t tick = used_stack();
    print(name);
    print_bytes(" grn_load, bytes of stack:", load);
    print(name);
    print_bytes(" grn_tick, bytes of stack:", tick);
}

static int run(void) {
#ifdef OTHER_VARIABLES
    other_variables[0] = 1;
#endif
    handle = console(APPEND);
    measure_stack(GRN_NUMBER_F32, "f32");
    measure_stack(GRN_NUMBER_Q8_24, "q8.24");
    handle = console(WRITE);
    return scene(blob, (size_t)(blob_end - blob), print);
}

// Start-up: floating point on, static data in place, then run, then exit with what it returns.
extern uint32_t data_start[], data_end[], data_in_flash[], bss_start[], bss_end[];

void start(void) {
    *(volatile uint32_t *)0xe000ed88 |= 0xfu << 20;  // CPACR: full access to coprocessors 10 and 11
    __asm__ volatile("dsb\n isb");
    for (uint32_t *to = data_start, *from = data_in_flash; to < data_end;) *to++ = *from++;
    for (uint32_t *word = bss_start; word < bss_end;) *word++ = 0;
    const uint32_t application_exit = 0x20026;
    semihosting(SYS_EXIT_EXTENDED, (const uintptr_t[]){application_exit, (uintptr_t)run()});
    for (;;) {}
}

static void fault(void) {
    const uint32_t run_time_error = 0x20023;
    semihosting(SYS_EXIT_EXTENDED, (const uintptr_t[]){run_time_error, 3});
    for (;;) {}
}

// Stack pointer, reset, NMI, hard fault; no other exception is enabled.
__attribute__((section(".vectors"), used)) static const void *const vectors[] = {stack_top, start, fault, fault};
