"""Robots under control of `grn` in MuJoCo: the closed loop."""

from __future__ import annotations

import math
from typing import Callable, Optional

import grn
import mujoco
import numpy as np
from conditions import Clock, Draws, FarSense, Lab, Letter, Localisation, Place, Radio, Wheels, known
from world import BODY_RADIUS, PROXIMITY_RANGE, STEPS_PER_SECOND, World, build

FRAMES_PER_SECOND = 32
SETTLE = 10.0
# A mother robot sees so far in the scenario's metres.
REACH = 5.0
# A contact ends when the gap has grown beyond this, metres.
RELEASE_GAP = 0.001


class Touches:
    """Who touches whom, counted as `grn` counts: a contact begins once, and ends when both have parted."""

    def __init__(self, scenario: grn.Scenario) -> None:
        self.scenario = scenario
        self.pairs: set[tuple[int, int]] = set()
        self.walls: set[int] = set()

    def count(self, pairs: set[tuple[int, int]], walls: set[int], positions: np.ndarray) -> list[int]:
        apart = 2 * BODY_RADIUS + RELEASE_GAP
        still = {(a, b) for a, b in self.pairs if math.dist(positions[a], positions[b]) <= apart}
        near = {r for r in self.walls if self.scenario.clearance(positions[r]) <= BODY_RADIUS + RELEASE_GAP}
        begun = [len(pairs - self.pairs), len(walls - self.walls)]
        self.pairs, self.walls = pairs | still, walls | near
        return [*begun, len(self.pairs), len(self.walls)]


class Swarm:
    """Robots with their bodies, sensors and radios."""

    def __init__(self, blob: grn.Blob, scenario: grn.Scenario, lab: Lab, start: grn.Simulation, seed: int, speed: float):
        known(lab)
        if scenario.walls_change or scenario.changes:
            raise SystemExit(f"{scenario.name}: walls that move and targets that come and go are not built in MuJoCo")
        self.lab, self.speed = lab, speed
        self.scenario = scenario.scaled(blob.scale)
        self.reach = REACH * blob.scale
        self.samples = np.array(scenario.boundary_samples(), float).reshape(-1, 2) * blob.scale
        self.count, self.mothers = start.positions.shape[1], lab["robots"]["mothers"]
        robots = range(self.count)
        self.robots = [grn.Robot(blob, robot) for robot in robots]
        self.wheels = [Wheels(lab, seed, robot) for robot in robots]
        self.clocks = [Clock(lab, seed, robot) for robot in robots]
        self.localisation = [Localisation(lab, seed, robot) for robot in robots]
        self.radios = [Radio.of(lab, seed, robot) for robot in robots]
        self.far_senses = [FarSense(lab, seed, robot) for robot in range(self.mothers)]
        self.proximity = [Draws(seed, 6, robot) for robot in robots]
        self.gains = [[draws.factor(lab["proximity"]["gain"]) for _ in range(8)] for draws in self.proximity]
        self.world: World = build(
            self.scenario,
            start.positions[0],
            start.headings[0],
            [wheels.axle_factor for wheels in self.wheels],
            lab["bodies"]["target_radius_m"],
        )
        self.bearings = [math.radians(bearing) for bearing in lab["proximity"]["bearings_deg"]]
        self.travel = self.scenario.travel_s(speed)

    def targets(self, now: float) -> list[Place]:
        share = min(1.0, max(0.0, now - SETTLE) / self.travel) if self.travel else 0.0
        return [place for place in self.scenario.targets_at(share) if place is not None]

    def run(self, watch: Optional[Callable[[float], None]] = None) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Positions, targets and contacts of every 1/32 s until all targets have arrived."""
        frames = math.ceil((SETTLE + self.travel) * FRAMES_PER_SECOND)
        stride = STEPS_PER_SECOND // FRAMES_PER_SECOND
        world, touches = self.world, Touches(self.scenario)
        positions = [world.positions()]
        targets = [self.targets(0.0)]
        contacts = [[0, 0, 0, 0]]
        for frame in range(frames):
            pairs: set[tuple[int, int]] = set()
            walls: set[int] = set()
            for step in range(stride):
                now = (frame * stride + step) / STEPS_PER_SECOND
                self.think(now)
                mujoco.mj_step(world.model, world.data)
                more_pairs, more_walls = world.touching()
                pairs |= more_pairs
                walls |= more_walls
            # Contacts and poses of the last step are those before it.
            mujoco.mj_kinematics(world.model, world.data)
            positions.append(world.positions())
            targets.append(self.targets((frame + 1) / FRAMES_PER_SECOND))
            world.place_targets(targets[-1])
            contacts.append(touches.count(pairs, walls, positions[-1]))
            if watch and frame % FRAMES_PER_SECOND == 0:
                watch(frame / frames)
        return np.array(positions), np.array(targets), np.array(contacts)

    def think(self, now: float) -> None:
        """Lets every robot whose tick it is perceive and decide; what they say is heard in later ticks only."""
        due = [robot for robot in range(self.count) if self.clocks[robot].due(now)]
        measured = [robot for robot in range(self.count) if self.localisation[robot].due <= now + 1e-9]
        if not due and not measured:
            return
        mujoco.mj_kinematics(self.world.model, self.world.data)
        positions = [(float(x), float(y)) for x, y in self.world.positions()]
        headings = self.world.headings().tolist()
        for robot in measured:
            self.localisation[robot].measure(now, positions[robot], headings[robot])
        targets = self.targets(now)
        said = []
        for robot in due:
            command = self.tick(robot, now, positions, headings, targets)
            self.world.drive(robot, *self.wheels[robot].turn(command.steps_per_s))
            if command.broadcast is not None:
                said.append((robot, command.broadcast))
        for robot, message in said:
            self.broadcast(robot, message, now, positions)

    def tick(
        self, robot: int, now: float, positions: list[Place], headings: list[float], targets: list[Place]
    ) -> grn.Command:
        here = positions[robot]
        localisation = self.localisation[robot]
        fix = localisation.newest(now)
        seen: dict[int, Place] = {}
        obstacles: list[Place] = []
        if robot < self.mothers:
            seen, obstacles = self.far_senses[robot].look(here, self.reach, targets, self.samples, localisation.error)
        distances = [math.dist(here, place) for place in positions]
        return self.robots[robot].tick(
            position=None if fix is None else fix.position,
            heading=None if fix is None else fix.heading,
            pose_age=0.0 if fix is None else fix.age,
            elapsed=self.clocks[robot].tick(now),
            proximity=self.feel(robot, here, headings[robot], distances),
            targets=seen,
            obstacles=obstacles,
            heard=self.radios[robot].hear(now, distances),
        )

    def feel(self, robot: int, here: Place, heading: float, distances: list[float]) -> Optional[list[Optional[float]]]:
        """Free distances from the body's edge, as rays in the physics meet walls and robots; None if nothing is in reach."""
        reach = 2 * BODY_RADIUS + PROXIMITY_RANGE
        alone = sum(distance <= reach for distance in distances) == 1
        if alone and self.scenario.clearance(here) > BODY_RADIUS + PROXIMITY_RANGE:
            return None
        numbers, draws = self.lab["proximity"], self.proximity[robot]
        felt: list[Optional[float]] = []
        for bearing, gain in zip(self.bearings, self.gains[robot]):
            way = (math.cos(heading + bearing), math.sin(heading + bearing))
            free = self.world.ray(here, way, robot) - BODY_RADIUS
            if free > PROXIMITY_RANGE:
                felt.append(None)
                continue
            sensed = free * gain + draws.normal(numbers["noise_m"] + numbers["noise_growth"] * max(0.0, free))
            felt.append(max(0.0, sensed))
        return felt

    def broadcast(self, sender: int, message: grn.Message, now: float, positions: list[Place]) -> None:
        numbers = self.lab["radio"]
        for robot, radio in enumerate(self.radios):
            distance = math.dist(positions[robot], positions[sender])
            extra = (radio.fragments(message) - 1) / FRAMES_PER_SECOND
            # Nothing is heard in the tick in which it is said.
            letter = Letter(message, now, now + max(numbers["latency_s"], 1e-6) + extra)
            if robot == sender:
                if radio.draws.happens(numbers["echo"]):
                    radio.on_their_way.append((letter, sender))
            elif distance <= 2.0 * numbers["range_m"]:
                radio.carry(letter, sender, distance, self.blocked(sender, robot, positions, distance))

    def blocked(self, sender: int, robot: int, positions: list[Place], distance: float) -> bool:
        numbers = self.lab["radio"]
        if not (numbers["walls_block"] or numbers["bodies_block"]) or distance == 0.0:
            return False
        (x, y), (to_x, to_y) = positions[sender], positions[robot]
        # The receiver's own body is met a radius before its centre.
        way = ((to_x - x) / distance, (to_y - y) / distance)
        return self.world.ray((x, y), way, sender) < distance - 1.01 * BODY_RADIUS
