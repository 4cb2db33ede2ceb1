// A robot of grn in Webots: an E-puck of the E-puck2 kind, with GPS and compass in its turret slot.
//
// Arguments of the controller: BLOB NUMBER [MOTHER]
//   BLOB    the file that `grn evolve` wrote
//   NUMBER  the robot's own, unique in the swarm
//   MOTHER  "mother" for a robot with a far sense: its field `supervisor` must be TRUE. It sees the nodes TARGET0, TARGET1, …
//           and OBSTACLE0, OBSTACLE1, … (points on the walls, as close to each other as docs/units.md says) within RANGE.
#include <grn.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <webots/compass.h>
#include <webots/distance_sensor.h>
#include <webots/emitter.h>
#include <webots/gps.h>
#include <webots/motor.h>
#include <webots/receiver.h>
#include <webots/robot.h>
#include <webots/supervisor.h>

#define RANGE 1.25         // Of a mother robot's sight, metres, at the blob's scale of 0.25.
#define RADIANS_PER_STEP 0.0062831853
#define MOST_OBSTACLES 256

// Distance and reading of the proto's proximity sensors.
static const double LOOKUP[10][2] = {{0, 4095},      {0.005, 2133.33}, {0.01, 1465.73}, {0.015, 601.46}, {0.02, 383.84},
                                     {0.03, 234.93}, {0.04, 158.03},   {0.05, 120.0},   {0.06, 104.09},  {0.07, 67.19}};

static GrnController controller;
static uint8_t blob[1024];

static void stop(const char *what) {
    fprintf(stderr, "grn: %s\n", what);
    exit(EXIT_FAILURE);
}

static void check(GrnStatus status) {
    if (status != GRN_STATUS_OK) stop(grn_status_text(status));
}

static int16_t millimetres(double metres) {
    return (int16_t)lround(metres * 1e3);
}

// A reading as a free distance in 0.1 mm: the table backwards.
static uint16_t free_distance(double reading) {
    int row;
    if (reading >= LOOKUP[0][1]) return 0;
    for (row = 1; row < 10; row++) {
        if (reading >= LOOKUP[row][1]) {
            double share = (LOOKUP[row - 1][1] - reading) / (LOOKUP[row - 1][1] - LOOKUP[row][1]);
            double metres = LOOKUP[row - 1][0] + share * (LOOKUP[row][0] - LOOKUP[row - 1][0]);
            return metres > 0.05 ? UINT16_MAX : (uint16_t)lround(metres * 1e4);
        }
    }
    return UINT16_MAX;
}

// The node DEF_NAME followed by a number, or NULL.
static WbNodeRef node(const char *name, int number) {
    char def[32];
    snprintf(def, sizeof def, "%s%d", name, number);
    return wb_supervisor_node_get_from_def(def);
}

// What a mother robot sees: all targets in range, and walls a few points at a time.
static void look(GrnPercept *percept, const double *here) {
    static int next;
    int target, tried;
    for (target = 0; target < GRN_MAX_TARGETS; target++) {
        WbNodeRef seen = node("TARGET", target);
        const double *place = seen ? wb_supervisor_node_get_position(seen) : NULL;
        if (place && hypot(place[0] - here[0], place[1] - here[1]) <= RANGE) {
            GrnSighting *sighting = &percept->targets[percept->target_count++];
            sighting->target = (uint8_t)target;
            sighting->position.x = millimetres(place[0]);
            sighting->position.y = millimetres(place[1]);
        }
    }
    for (tried = 0; tried < MOST_OBSTACLES && percept->obstacle_count < GRN_MAX_SEEN_OBSTACLES; tried++) {
        WbNodeRef seen = node("OBSTACLE", next);
        const double *place = seen ? wb_supervisor_node_get_position(seen) : NULL;
        next = seen ? next + 1 : 0;
        if (!seen && tried > 0) break;
        if (place && hypot(place[0] - here[0], place[1] - here[1]) <= RANGE) {
            GrnMillimetres *point = &percept->obstacles[percept->obstacle_count++];
            point->x = millimetres(place[0]);
            point->y = millimetres(place[1]);
        }
    }
}

// Messages that fit, the strongest first: Webots gives the nearest no precedence, so the nearest of all that wait are kept.
static void hear(GrnPercept *percept, WbDeviceTag receiver, double age_s) {
    double strengths[GRN_MAX_HEARD];
    for (; wb_receiver_get_queue_length(receiver) > 0; wb_receiver_next_packet(receiver)) {
        GrnMessage message;
        int place = percept->heard_count, i;
        double strength = wb_receiver_get_signal_strength(receiver);
        const uint8_t *data = (const uint8_t *)wb_receiver_get_data(receiver);
        if (grn_message_read(data, (size_t)wb_receiver_get_data_size(receiver), &message) != GRN_STATUS_OK) continue;
        if (place == GRN_MAX_HEARD) {
            for (place = 0, i = 1; i < GRN_MAX_HEARD; i++) place = strengths[i] < strengths[place] ? i : place;
            if (strength <= strengths[place]) continue;
        } else {
            percept->heard_count++;
        }
        percept->heard[place].message = message;
        percept->heard[place].age_ms = (uint16_t)lround(age_s * 1e3);
        strengths[place] = strength;
    }
}

int main(int argc, char **argv) {
    WbDeviceTag sensors[GRN_PROXIMITY_SENSORS], left, right, gps, compass, emitter, receiver;
    int is_mother = argc == 4 && strcmp(argv[3], "mother") == 0, i, step;
    double before = 0.0;
    size_t length;
    FILE *file;
    wb_robot_init();
    if (argc < 3) stop("arguments: BLOB NUMBER [mother]");
    file = fopen(argv[1], "rb");
    if (!file) stop("the blob cannot be opened");
    length = fread(blob, 1, sizeof blob, file);
    fclose(file);
    check(grn_load(&controller, sizeof controller, blob, length, GRN_NUMBER_F32, (uint16_t)atoi(argv[2])));
    // Ticks come at whole steps of the world, and the controller is told how long they took: 32 ms of a usual world is near enough to 1/32 s.
    step = (int)wb_robot_get_basic_time_step();
    while (step < 31) step += (int)wb_robot_get_basic_time_step();
    for (i = 0; i < GRN_PROXIMITY_SENSORS; i++) {
        char name[8];
        snprintf(name, sizeof name, "ps%d", i);
        sensors[i] = wb_robot_get_device(name);
        wb_distance_sensor_enable(sensors[i], step);
    }
    left = wb_robot_get_device("left wheel motor");
    right = wb_robot_get_device("right wheel motor");
    wb_motor_set_position(left, INFINITY);
    wb_motor_set_position(right, INFINITY);
    gps = wb_robot_get_device("gps");
    compass = wb_robot_get_device("compass");
    emitter = wb_robot_get_device("emitter");
    receiver = wb_robot_get_device("receiver");
    wb_gps_enable(gps, step);
    wb_compass_enable(compass, step);
    wb_receiver_enable(receiver, step);
    while (wb_robot_step(step) != -1) {
        GrnPercept percept = GRN_PERCEPT_NOTHING;
        GrnCommand command;
        double now = wb_robot_get_time();
        const double *here = wb_gps_get_values(gps), *north = wb_compass_get_values(compass);
        if (before > 0.0) percept.elapsed_us = (uint32_t)lround((now - before) * 1e6);
        before = now;
        // In the world's frame ENU the compass points to y, so its first two values are sine and cosine of the heading.
        percept.has_fix = isfinite(here[0]) && isfinite(north[0]);
        if (percept.has_fix) {
            percept.fix.position[0] = (int32_t)lround(here[0] * 1e6);
            percept.fix.position[1] = (int32_t)lround(here[1] * 1e6);
            percept.fix.heading[0] = (int16_t)lround(north[1] * 16384);
            percept.fix.heading[1] = (int16_t)lround(north[0] * 16384);
        }
        for (i = 0; i < GRN_PROXIMITY_SENSORS; i++) {
            percept.proximity[i] = free_distance(wb_distance_sensor_get_value(sensors[i]));
        }
        if (is_mother && percept.has_fix) look(&percept, here);
        hear(&percept, receiver, step * 1e-3);
        check(grn_tick(&controller, &percept, &command));
        wb_motor_set_velocity(left, command.left * RADIANS_PER_STEP);
        wb_motor_set_velocity(right, command.right * RADIANS_PER_STEP);
        if (command.has_broadcast) {
            uint8_t packed[GRN_PACKED_MESSAGE_BYTES];
            check(grn_message_write(&command.broadcast, packed, sizeof packed, &length));
            wb_emitter_send(emitter, packed, (int)length);
        }
    }
    wb_robot_cleanup();
    return EXIT_SUCCESS;
}
