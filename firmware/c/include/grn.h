// The grn controller as a C library. Made from the Rust sources by cbindgen: do not edit.
//
// A robot loads a blob (a file that `grn evolve` wrote) into storage of its own and then ticks 32 times a second:
//
//     static GrnController controller;
//     GrnStatus status = grn_load(&controller, sizeof controller, blob, length, GRN_NUMBER_F32, robot);
//     if (status != GRN_STATUS_OK) puts(grn_status_text(status));
//     ...
//     GrnPercept percept = GRN_PERCEPT_NOTHING;             // then what the robot perceives
//     status = grn_tick(&controller, &percept, &command);   // every 1/32 s; then set the wheels to command
//
// The library allocates nothing and keeps no state of its own; equal blobs and percepts give equal commands, bit for bit,
// on every machine. A pointer that is null or misaligned is refused with a status. A pointer that is neither must point
// to a whole object, which nobody else uses during the call: one controller is for one thread at a time, while different
// controllers know nothing of each other.
//
// The world is right-handed, x east, y north. docs/units.md converts units.

#ifndef GRN_H
#define GRN_H

#include <stddef.h>
#include <stdint.h>

// The version of this header; grn_version says that of the library. Before 1.0.0 minor versions are not compatible
// with each other.
#define GRN_VERSION_MAJOR 0
#define GRN_VERSION_MINOR 2
#define GRN_VERSION_PATCH 0
#define GRN_VERSION_STRING "0.2.0"


// The size of a loaded controller in units of 8 bytes, with some to spare for later versions.
#define GRN_CONTROLLER_WORDS 319

// How often grn_tick is to be called.
#define GRN_TICKS_PER_SECOND 32

// The time from one tick to the next, microseconds, if ticks come on time.
#define GRN_NOMINAL_TICK_US 31250

// How many proximity sensors the ring has.
#define GRN_PROXIMITY_SENSORS 8

// The most targets in a percept.
#define GRN_MAX_TARGETS 4

// The most obstacle points in a percept.
#define GRN_MAX_SEEN_OBSTACLES 8

// The most messages in a percept.
#define GRN_MAX_HEARD 8

// The most obstacle points in a message.
#define GRN_MAX_REPORTED_OBSTACLES 4

// The bytes of a blob's identity.
#define GRN_IDENTITY_BYTES 8

// The most bytes of a packed message.
#define GRN_PACKED_MESSAGE_BYTES 37

// The smallest payload that a fragment fits.
#define GRN_MIN_PAYLOAD_BYTES 2

// The most bytes of a fragment.
#define GRN_MAX_FRAGMENT_BYTES 39

// The size of an assembler in units of 8 bytes, with some to spare for later versions.
#define GRN_ASSEMBLER_WORDS 96

// What became of a call. The numbers of released statuses never change; grn_status_text says what to do.
enum GrnStatus
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Done.
    GRN_STATUS_OK = 0,
    // A pointer is null.
    GRN_STATUS_NULL_POINTER = 1,
    // A pointer is not aligned for what it points to.
    GRN_STATUS_MISALIGNED = 2,
    // The storage is smaller than this library's GrnController.
    GRN_STATUS_STORAGE_TOO_SMALL = 3,
    // No controller is loaded in this storage.
    GRN_STATUS_NOT_LOADED = 4,
    // The number type is none of GrnNumber.
    GRN_STATUS_UNKNOWN_NUMBER = 5,
    // The percept counts more than GRN_MAX_TARGETS targets.
    GRN_STATUS_TOO_MANY_TARGETS = 10,
    // The percept counts more than GRN_MAX_SEEN_OBSTACLES obstacle points.
    GRN_STATUS_TOO_MANY_OBSTACLES = 11,
    // The percept counts more than GRN_MAX_HEARD messages.
    GRN_STATUS_TOO_MANY_HEARD = 12,
    // A message counts more than GRN_MAX_REPORTED_OBSTACLES obstacle points.
    GRN_STATUS_TOO_MANY_REPORTED = 13,
    // The percept's heading is not a unit vector: its length is not 16384, give or take a 32nd.
    GRN_STATUS_HEADING = 14,
    // The percept's position is farther from the origin than 32767000 micrometres, east or north.
    GRN_STATUS_POSITION = 15,
    // The percept's time since the last tick is not 1000 to 250000 microseconds.
    GRN_STATUS_ELAPSED = 16,
    // The bytes end before the blob's header does.
    GRN_STATUS_BLOB_TRUNCATED = 20,
    // The bytes do not begin as a blob does.
    GRN_STATUS_NOT_A_BLOB = 21,
    // The blob has an older format version than this library reads.
    GRN_STATUS_BLOB_TOO_OLD = 22,
    // The blob has a newer format version than this library reads.
    GRN_STATUS_BLOB_TOO_NEW = 23,
    // There are more or fewer bytes than the blob's header says.
    GRN_STATUS_BLOB_LENGTH = 24,
    // The blob's checksum or identity is not that of its content.
    GRN_STATUS_BLOB_DAMAGED = 25,
    // The blob has another convention for frame, units and normalisation.
    GRN_STATUS_BLOB_CONVENTION = 26,
    // The blob's content is not, byte for byte, what a writer of this format writes.
    GRN_STATUS_BLOB_MALFORMED = 27,
    // The blob's network has more genes than this build holds.
    GRN_STATUS_NETWORK_TOO_LARGE = 28,
    // A gene's input or a parameter in the blob is out of its range.
    GRN_STATUS_BLOB_OUT_OF_RANGE = 29,
    // The blob has a motif or kernel that this library does not know.
    GRN_STATUS_BLOB_UNKNOWN_CODE = 30,
    // The model does not tell targets from empty space.
    GRN_STATUS_NO_PATTERN = 40,
    // The model's pattern does not close around a lone target.
    GRN_STATUS_NO_RING = 41,
    // Time scale and integration step do not give a whole number of steps in a tick, or too many.
    GRN_STATUS_STEPS_PER_TICK = 42,
    // The packed message does not fit the bytes that are there for it.
    GRN_STATUS_BUFFER_TOO_SMALL = 50,
    // There are more or fewer bytes than the packed message has.
    GRN_STATUS_MESSAGE_LENGTH = 51,
    // The packed message was damaged on the way.
    GRN_STATUS_MESSAGE_DAMAGED = 52,
    // The packed message is undamaged but of another version.
    GRN_STATUS_MESSAGE_VERSION = 53,
    // The radio's payload is smaller than GRN_MIN_PAYLOAD_BYTES.
    GRN_STATUS_PAYLOAD_TOO_SMALL = 54,
    // No fault: the fragment was taken in, and its message is not complete yet, or was before.
    GRN_STATUS_MESSAGE_INCOMPLETE = 55,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum GrnStatus GrnStatus;
#else
typedef int32_t GrnStatus;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What a controller computes with. Both follow the same law; each gives the same bits on every machine.
enum GrnNumber
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
    // Single-precision floating point.
    GRN_NUMBER_F32 = 1,
    // Fixed point with 24 fractional bits, for processors without a floating-point unit.
    GRN_NUMBER_Q8_24 = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum GrnNumber GrnNumber;
#else
typedef int32_t GrnNumber;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Storage for one controller, owned by the caller: 2560 bytes, 8-aligned.
//
// To be zero before the first grn_load, as static storage is and as "GrnController controller = {0};" makes it: so a
// controller that nobody loaded is told from one that was. Loaded, it holds no pointers and may be copied.
typedef struct GrnController {
    // What is loaded; 0 for nothing. Written by the library only, as all of the storage.
    uint64_t magic;
    // The controller, if one is loaded.
    uint64_t opaque[GRN_CONTROLLER_WORDS];
} GrnController;

// What a localisation system says of the robot: where it was and how it looked when that was measured.
typedef struct GrnFix {
    // Own position in the world, micrometres: east, north; each within 32767000 either way.
    int32_t position[2];
    // Own heading as (cos, sin), in units of 2^-14, anticlockwise from east: 16384, 0 is east, 0, 16384 is north. The
    // length of this vector may be a 32nd off 16384, that is from 15872 to 16896.
    int16_t heading[2];
    // How long ago it was measured, milliseconds; 0 if that is not known.
    uint16_t age_ms;
    // 0; not read.
    uint8_t reserved[2];
} GrnFix;

// A position in the world, millimetres, within 32767 either way.
typedef struct GrnMillimetres {
    // East.
    int16_t x;
    // North.
    int16_t y;
} GrnMillimetres;

// A target seen with the robot's own sensors.
typedef struct GrnSighting {
    // Which target: targets can be told apart.
    uint8_t target;
    // 0; not read.
    uint8_t reserved;
    // Where it is.
    struct GrnMillimetres position;
} GrnSighting;

// A target as somebody knows it.
typedef struct GrnTargetReport {
    // Which target.
    uint8_t target;
    // 0; not read.
    uint8_t reserved0;
    // Where the sender expects it at the time of sending.
    struct GrnMillimetres position;
    // Its velocity, millimetres per second: east, north.
    int8_t velocity[2];
    // Ticks since it was seen, over all relays; 255 means at least that.
    uint8_t age;
    // 0; not read.
    uint8_t reserved1;
} GrnTargetReport;

// An obstacle point as somebody knows it.
typedef struct GrnObstacleReport {
    // A point on the obstacle's boundary.
    struct GrnMillimetres position;
    // Units of 8 ticks since it was seen, over all relays; 255 means at least that.
    uint8_t age;
    // 0; not read.
    uint8_t reserved;
} GrnObstacleReport;

// What robots tell each other by radio: who and where I am, and some of what I know.
//
// To be sent, use grn_message_write, whose bytes are fewer, the same on all machines, and protected by a checksum.
typedef struct GrnMessage {
    // Number of the robot that sends, unique in the swarm.
    uint16_t sender;
    // Where it is.
    struct GrnMillimetres position;
    // 0 if it tells of no target; then "target" is not read.
    uint8_t has_target;
    // 0; not read.
    uint8_t reserved0;
    // One of the targets it knows, in turn.
    struct GrnTargetReport target;
    // How many of "obstacles" there are, from 0 to GRN_MAX_REPORTED_OBSTACLES.
    uint8_t obstacle_count;
    // 0; not read.
    uint8_t reserved1;
    // Some of the obstacle points it knows, in turn.
    struct GrnObstacleReport obstacles[GRN_MAX_REPORTED_OBSTACLES];
} GrnMessage;

// A message received by radio.
typedef struct GrnHeard {
    // What was said.
    struct GrnMessage message;
    // How long it was on its way as far as the radio knows, milliseconds; 0 if that is not known.
    uint16_t age_ms;
} GrnHeard;

// Everything a robot perceives in one tick.
//
// Begin every tick with GRN_PERCEPT_NOTHING or grn_percept_nothing, then put in what is perceived. Zeros mean something
// else than nothing: obstacles that touch the robot on all sides; grn_tick refuses them, because no time has elapsed.
typedef struct GrnPercept {
    // Time since the last tick, microseconds, from 1000 to 250000; GRN_NOMINAL_TICK_US if ticks come on time.
    uint32_t elapsed_us;
    // Where the robot is, if the localisation system has said so since the last tick.
    struct GrnFix fix;
    // Free distance in front of each proximity sensor, from the body's edge, in units of 0.1 mm; UINT16_MAX when
    // nothing is in range (5 cm). Bearings from the heading, degrees, left positive: -17, -50, -90, -150, 150, 90, 50, 17.
    uint16_t proximity[GRN_PROXIMITY_SENSORS];
    // 0 if there is no new fix; then "fix" is not read.
    uint8_t has_fix;
    // How many of "targets" there are, from 0 to GRN_MAX_TARGETS.
    uint8_t target_count;
    // Targets seen with own sensors (mother robots).
    struct GrnSighting targets[GRN_MAX_TARGETS];
    // How many of "obstacles" there are, from 0 to GRN_MAX_SEEN_OBSTACLES.
    uint8_t obstacle_count;
    // How many of "heard" there are, from 0 to GRN_MAX_HEARD.
    uint8_t heard_count;
    // Points on obstacles seen with own sensors (mother robots).
    struct GrnMillimetres obstacles[GRN_MAX_SEEN_OBSTACLES];
    // Messages received since the last tick; of more, the strongest. The robot's own, which some radios give back, are
    // ignored.
    struct GrnHeard heard[GRN_MAX_HEARD];
} GrnPercept;

// What a robot does until the next tick.
typedef struct GrnCommand {
    // Left wheel, motor steps per second (0.1288 mm each), forward positive, within 1100 either way.
    int16_t left;
    // Right wheel, likewise.
    int16_t right;
    // 1 if there is a message to broadcast in this tick, else 0.
    uint8_t has_broadcast;
    // 0.
    uint8_t reserved;
    // The message; all zero without one.
    struct GrnMessage broadcast;
} GrnCommand;

// Puts the fragments of messages together that a radio with small payloads delivers: 768 bytes, 8-aligned, owned by the
// caller.
//
// Zeros are an assembler that has heard nothing: static storage, or "GrnAssembler assembler = {0};".
typedef struct GrnAssembler {
    // Written by the library only.
    uint64_t opaque[GRN_ASSEMBLER_WORDS];
} GrnAssembler;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Loads a blob into a controller, all genes silent and nothing known.
//
// `controller`: the storage; whatever it holds is overwritten.
// `controller_size`: sizeof(GrnController), which tells whether this header fits the library.
// `blob`, `length`: the bytes of the blob, for example a file or a place in flash; they are not needed any more after
// the call.
// `number`: what to compute with, a GrnNumber.
// `robot`: this robot's number, unique in the swarm.
//
// Returns GRN_STATUS_OK, or why the blob is refused; the storage then holds no controller and grn_tick refuses it.
GrnStatus grn_load(struct GrnController *controller,
                   size_t controller_size,
                   const uint8_t *blob,
                   size_t length,
                   int32_t number,
                   uint16_t robot);

// Says what grn_load would say about a blob, without storage: for example before it is kept in flash.
//
// `blob`, `length`, `number`: as for grn_load.
//
// Takes about as much stack as grn_load.
GrnStatus grn_check(const uint8_t *blob, size_t length, int32_t number);

// The percept of a robot that perceives nothing, not even where it is: what GRN_PERCEPT_NOTHING is.
//
// `percept`: receives it; then put in what is perceived.
GrnStatus grn_percept_nothing(struct GrnPercept *percept);

// One control tick: perceive, express genes, move. To be called GRN_TICKS_PER_SECOND times a second,
// or as often as "elapsed_us" of the percepts says.
//
// `percept`: what the robot perceives; entries beyond a count are not read. Before the first fix the robot stands still.
// `command`: receives what the robot does until the next tick.
//
// Returns GRN_STATUS_OK, or what is wrong; the controller is then as before, and `command`, if it is a pointer to one,
// stops the wheels and sends nothing.
GrnStatus grn_tick(struct GrnController *controller,
                   const struct GrnPercept *percept,
                   struct GrnCommand *command);

// The same for a robot whose base station calls it home: it drives there, straight on and around what its proximity sensors
// feel, instead of to the pattern. In any later tick it may go back to the pattern with grn_tick.
//
// `percept`, `command`: as for grn_tick.
// `home`: where it is to go.
//
// Returns what grn_tick returns.
GrnStatus grn_tick_home(struct GrnController *controller,
                        const struct GrnPercept *percept,
                        struct GrnMillimetres home,
                        struct GrnCommand *command);

// The level of the pattern morphogen M at the robot, as its genes express it now: 0 before the first target is known, then
// about 0 to 1. A last gene XNOR may take it a little below 0, a last gene XOR a little above 1.
//
// `morphogen`: receives it, without loss for both number types.
GrnStatus grn_morphogen(const struct GrnController *controller,
                        float *morphogen);

// The identity of the blob that runs: the first 8 bytes of the SHA-256 of its payload, which `grn show` prints.
//
// `identity`: receives GRN_IDENTITY_BYTES bytes.
GrnStatus grn_identity(const struct GrnController *controller, uint8_t *identity);

// What a status means and what to do about it: one line in English, ASCII, without a line end; never null.
//
// `status`: a GrnStatus; another number has a text that says so.
const char *grn_status_text(int32_t status);

// The version of this library, like "0.1.0"; never null.
const char *grn_version(void);

// The format version of the blobs this library reads.
uint8_t grn_blob_format_version(void);

// Packs a message for a radio: 9 to GRN_PACKED_MESSAGE_BYTES bytes with a checksum, the same on every machine.
//
// `message`: for example the broadcast of a command.
// `bytes`, `capacity`: receive the packed message; GRN_PACKED_MESSAGE_BYTES are always enough.
// `length`: receives how many bytes there are; 0 if the message is refused.
//
// docs/messages.md describes the bytes. Radios with smaller payloads use grn_message_fragment.
GrnStatus grn_message_write(const struct GrnMessage *message, uint8_t *bytes, size_t capacity, size_t *length);

// Unpacks a message that grn_message_write packed.
//
// `bytes`, `length`: exactly the bytes of one packed message.
// `message`: receives it, for the percept's "heard"; all zero if it is refused.
//
// Returns GRN_STATUS_OK, or why it is refused: damaged messages are to be dropped.
GrnStatus grn_message_read(const uint8_t *bytes, size_t length, struct GrnMessage *message);

// Cuts a message for a radio with small payloads, down to GRN_MIN_PAYLOAD_BYTES: gives one of its fragments.
//
// `message`: for example the broadcast of a command.
// `number`: counts the messages that this robot sends; it may wrap around.
// `payload`: how many bytes the radio carries at a time. The longest message takes 50 fragments of 2 bytes, 37 of 3,
// 7 of 8, or 2 of 21 to 38.
// `index`: which fragment, from 0.
// `fragment`: receives it; room for `payload` bytes, of which no more than GRN_MAX_FRAGMENT_BYTES are used.
// `length`: receives how many bytes it has; 0 if the message has fewer fragments.
//
// Fragments may be sent in any order and more than once.
GrnStatus grn_message_fragment(const struct GrnMessage *message,
                               uint8_t number,
                               size_t payload,
                               size_t index,
                               uint8_t *fragment,
                               size_t *length);

// Takes in a fragment that was heard; gives a message if that completes it.
//
// `assembler`: what was heard so far.
// `assembler_size`: sizeof(GrnAssembler), which tells whether this header fits the library.
// `tick`: counts the control ticks, from anywhere; fragments that belong together and are long apart are told by it.
// `fragment`, `length`: exactly the bytes that the radio delivered.
// `message`: receives the message, for the percept's "heard"; all zero if none is complete.
//
// Returns GRN_STATUS_OK if a message is complete and undamaged, else GRN_STATUS_MESSAGE_INCOMPLETE or what is wrong.
// Fragments may be lost, come twice, and overtake each other. Messages of eight robots are put together at a time.
GrnStatus grn_assembler_receive(struct GrnAssembler *assembler,
                                size_t assembler_size,
                                uint32_t tick,
                                const uint8_t *fragment,
                                size_t length,
                                struct GrnMessage *message);

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

// A percept in which nothing is perceived. To begin every tick with:
//
//     GrnPercept percept = GRN_PERCEPT_NOTHING;
#ifdef __cplusplus
#define GRN_NO_ENTRIES {}
#define GRN_NO_MESSAGES {}
#else
#define GRN_NO_ENTRIES {{0}}
#define GRN_NO_MESSAGES {{{0}, 0}}
#endif
#define GRN_PERCEPT_NOTHING \
    {GRN_NOMINAL_TICK_US, {{0, 0}, {0, 0}, 0, {0, 0}}, \
     {UINT16_MAX, UINT16_MAX, UINT16_MAX, UINT16_MAX, UINT16_MAX, UINT16_MAX, UINT16_MAX, UINT16_MAX}, \
     0, 0, GRN_NO_ENTRIES, 0, 0, GRN_NO_ENTRIES, GRN_NO_MESSAGES}

// The compiler lays out all structures as the library does. Checked from C11 and C++11 on.
#if defined(__cplusplus) && __cplusplus >= 201103L
#define GRN_ASSERT_LAYOUT(condition) static_assert(condition, "grn.h does not fit this compiler or its options")
#elif !defined(__cplusplus) && defined(__STDC_VERSION__) && __STDC_VERSION__ >= 201112L
#define GRN_ASSERT_LAYOUT(condition) _Static_assert(condition, "grn.h does not fit this compiler or its options")
#endif
#ifdef GRN_ASSERT_LAYOUT
GRN_ASSERT_LAYOUT(sizeof(GrnController) == 2560);
GRN_ASSERT_LAYOUT(sizeof(GrnAssembler) == 768);
GRN_ASSERT_LAYOUT(sizeof(GrnStatus) == 4 && sizeof(GrnNumber) == 4);
GRN_ASSERT_LAYOUT(sizeof(GrnMillimetres) == 4);
GRN_ASSERT_LAYOUT(offsetof(GrnMillimetres, x) == 0);
GRN_ASSERT_LAYOUT(offsetof(GrnMillimetres, y) == 2);
GRN_ASSERT_LAYOUT(sizeof(GrnSighting) == 6);
GRN_ASSERT_LAYOUT(offsetof(GrnSighting, target) == 0);
GRN_ASSERT_LAYOUT(offsetof(GrnSighting, reserved) == 1);
GRN_ASSERT_LAYOUT(offsetof(GrnSighting, position) == 2);
GRN_ASSERT_LAYOUT(sizeof(GrnTargetReport) == 10);
GRN_ASSERT_LAYOUT(offsetof(GrnTargetReport, target) == 0);
GRN_ASSERT_LAYOUT(offsetof(GrnTargetReport, reserved0) == 1);
GRN_ASSERT_LAYOUT(offsetof(GrnTargetReport, position) == 2);
GRN_ASSERT_LAYOUT(offsetof(GrnTargetReport, velocity) == 6);
GRN_ASSERT_LAYOUT(offsetof(GrnTargetReport, age) == 8);
GRN_ASSERT_LAYOUT(offsetof(GrnTargetReport, reserved1) == 9);
GRN_ASSERT_LAYOUT(sizeof(GrnObstacleReport) == 6);
GRN_ASSERT_LAYOUT(offsetof(GrnObstacleReport, position) == 0);
GRN_ASSERT_LAYOUT(offsetof(GrnObstacleReport, age) == 4);
GRN_ASSERT_LAYOUT(offsetof(GrnObstacleReport, reserved) == 5);
GRN_ASSERT_LAYOUT(sizeof(GrnMessage) == 44);
GRN_ASSERT_LAYOUT(offsetof(GrnMessage, sender) == 0);
GRN_ASSERT_LAYOUT(offsetof(GrnMessage, position) == 2);
GRN_ASSERT_LAYOUT(offsetof(GrnMessage, has_target) == 6);
GRN_ASSERT_LAYOUT(offsetof(GrnMessage, reserved0) == 7);
GRN_ASSERT_LAYOUT(offsetof(GrnMessage, target) == 8);
GRN_ASSERT_LAYOUT(offsetof(GrnMessage, obstacle_count) == 18);
GRN_ASSERT_LAYOUT(offsetof(GrnMessage, reserved1) == 19);
GRN_ASSERT_LAYOUT(offsetof(GrnMessage, obstacles) == 20);
GRN_ASSERT_LAYOUT(sizeof(GrnHeard) == 46);
GRN_ASSERT_LAYOUT(offsetof(GrnHeard, message) == 0);
GRN_ASSERT_LAYOUT(offsetof(GrnHeard, age_ms) == 44);
GRN_ASSERT_LAYOUT(sizeof(GrnFix) == 16);
GRN_ASSERT_LAYOUT(offsetof(GrnFix, position) == 0);
GRN_ASSERT_LAYOUT(offsetof(GrnFix, heading) == 8);
GRN_ASSERT_LAYOUT(offsetof(GrnFix, age_ms) == 12);
GRN_ASSERT_LAYOUT(offsetof(GrnFix, reserved) == 14);
GRN_ASSERT_LAYOUT(sizeof(GrnPercept) == 464);
GRN_ASSERT_LAYOUT(offsetof(GrnPercept, elapsed_us) == 0);
GRN_ASSERT_LAYOUT(offsetof(GrnPercept, fix) == 4);
GRN_ASSERT_LAYOUT(offsetof(GrnPercept, proximity) == 20);
GRN_ASSERT_LAYOUT(offsetof(GrnPercept, has_fix) == 36);
GRN_ASSERT_LAYOUT(offsetof(GrnPercept, target_count) == 37);
GRN_ASSERT_LAYOUT(offsetof(GrnPercept, targets) == 38);
GRN_ASSERT_LAYOUT(offsetof(GrnPercept, obstacle_count) == 62);
GRN_ASSERT_LAYOUT(offsetof(GrnPercept, heard_count) == 63);
GRN_ASSERT_LAYOUT(offsetof(GrnPercept, obstacles) == 64);
GRN_ASSERT_LAYOUT(offsetof(GrnPercept, heard) == 96);
GRN_ASSERT_LAYOUT(sizeof(GrnCommand) == 50);
GRN_ASSERT_LAYOUT(offsetof(GrnCommand, left) == 0);
GRN_ASSERT_LAYOUT(offsetof(GrnCommand, right) == 2);
GRN_ASSERT_LAYOUT(offsetof(GrnCommand, has_broadcast) == 4);
GRN_ASSERT_LAYOUT(offsetof(GrnCommand, reserved) == 5);
GRN_ASSERT_LAYOUT(offsetof(GrnCommand, broadcast) == 6);
#undef GRN_ASSERT_LAYOUT
#endif

#endif  /* GRN_H */
