"""A laboratory's numbers as disturbances of a closed loop, with the meanings that `grn lab ideal` tells.

They are written anew here, in Python and with NumPy's random numbers, so that the two simulators share the numbers only:
where both agree, neither has its own mistake.
"""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, field
from typing import Any, Mapping, Optional, Sequence

import grn
import numpy as np

Lab = Mapping[str, Any]
Place = tuple[float, float]
# East, north, anticlockwise: metres and radians.
PoseError = tuple[float, float, float]
NOISE_LIMIT = 3.5


def known(lab: Lab) -> None:
    """Refuses what is not rebuilt here."""
    faults = lab.get("faults", {})
    rates = [rate for key, rate in faults.items() if key.endswith("_per_hour")]
    if faults.get("at") or any(rates):
        raise SystemExit(f"laboratory {lab['name']}: faults are not rebuilt in MuJoCo; take one without")
    if lab["base_station"]["sends"]:
        raise SystemExit(f"laboratory {lab['name']}: a base station is not rebuilt in MuJoCo; take one without")
    if lab["proximity"]["aperture_deg"] > 0.0:
        print("note: a proximity sensor has one ray here, not three")
    if lab["proximity"]["response"] != "distance":
        print(f"note: proximity readings are taken as distances, not through the curve of {lab['proximity']['response']}")


class Draws:
    """Random numbers of one component of one robot."""

    def __init__(self, seed: int, component: int, robot: int) -> None:
        self.generator = np.random.default_rng([seed, component, robot])

    def normal(self, deviation: float) -> float:
        if deviation == 0.0:
            return 0.0
        return deviation * max(-NOISE_LIMIT, min(NOISE_LIMIT, self.generator.normal()))

    def factor(self, gain: float) -> float:
        return 1.0 + gain * float(self.generator.uniform(-1.0, 1.0))

    def happens(self, probability: float) -> bool:
        return probability > 0.0 and self.generator.random() < probability


class Bursts:
    """Misfortunes of a given probability that come in rows of a given mean length (Gilbert's model)."""

    def __init__(self, share: float, mean_length_s: float, period_s: float, draws: Draws) -> None:
        self.share, self.draws = share, draws
        self.leave = min(1.0, period_s / mean_length_s) if mean_length_s > 0.0 else None
        self.inside = draws.happens(share)

    def next(self) -> bool:
        if self.leave is None or self.share in (0.0, 1.0):
            return self.draws.happens(self.share)
        enter = min(1.0, self.leave * self.share / (1.0 - self.share))
        self.inside = not self.draws.happens(self.leave) if self.inside else self.draws.happens(enter)
        return self.inside


@dataclass
class Fix:
    position: Place
    heading: float
    age: float


class Localisation:
    """What a tracking system tells one robot of its pose."""

    def __init__(self, lab: Lab, seed: int, robot: int) -> None:
        self.numbers = lab["localisation"]
        self.draws = Draws(seed, 1, robot)
        self.period = 1.0 / self.numbers["rate_hz"]
        self.due = 0.0
        self.gaps = Bursts(self.numbers["dropout"], self.numbers["dropout_s"], self.period, self.draws)
        self.drifts = self.numbers["drift_m"] > 0.0 or self.numbers["drift_deg"] > 0.0
        self.drift = [self.draws.normal(1.0) for _ in range(3)]
        self.drift_at = 0.0
        self.on_its_way: deque[tuple[float, Place, float]] = deque()
        self.error: PoseError = (0.0, 0.0, 0.0)

    def measure(self, now: float, position: Place, heading: float) -> None:
        if now < self.due - 1e-9:
            return
        self.due += self.period
        if self.gaps.next():
            return
        numbers = self.numbers
        if self.drifts:
            # The exact transition of an Ornstein-Uhlenbeck process of deviation 1.
            kept = math.exp(-(now - self.drift_at) / numbers["drift_s"])
            fresh = math.sqrt(1.0 - kept * kept)
            self.drift = [kept * value + fresh * self.draws.normal(1.0) for value in self.drift]
            self.drift_at = now
        east = self.draws.normal(numbers["noise_m"]) + self.drift[0] * numbers["drift_m"]
        north = self.draws.normal(numbers["noise_m"]) + self.drift[1] * numbers["drift_m"]
        turn = math.radians(self.draws.normal(numbers["noise_deg"]) + self.drift[2] * numbers["drift_deg"])
        self.error = (east, north, turn)
        x, y = position
        self.on_its_way.append((now, (x + east, y + north), heading + turn))

    def newest(self, now: float) -> Optional[Fix]:
        newest = None
        while self.on_its_way and self.on_its_way[0][0] + self.numbers["latency_s"] <= now + 1e-9:
            measured, position, heading = self.on_its_way.popleft()
            newest = Fix(position, heading, max(0.0, now - measured))
        return newest


class FarSense:
    """What a mother robot sees: all targets in range, and points on walls a few at a time."""

    PER_TICK = 8

    def __init__(self, lab: Lab, seed: int, robot: int) -> None:
        self.numbers = lab["sighting"]
        self.draws = Draws(seed, 2, robot)
        self.queue: list[int] = []

    def look(
        self, position: Place, reach: float, targets: Sequence[Place], samples: np.ndarray, error: PoseError
    ) -> tuple[dict[int, Place], list[Place]]:
        x, y = position
        east, north, turn = error if self.numbers["own_pose_error"] else (0.0, 0.0, 0.0)
        cos, sin = math.cos(turn), math.sin(turn)

        def seen(thing: Place) -> Place:
            dx, dy = thing[0] - x, thing[1] - y
            noise = self.numbers["noise_m"]
            return (
                x + east + cos * dx - sin * dy + self.draws.normal(noise),
                y + north + sin * dx + cos * dy + self.draws.normal(noise),
            )

        near = {number: seen(place) for number, place in enumerate(targets) if math.dist(place, position) <= reach}
        if not self.queue and len(samples):
            distances = np.hypot(*(samples - position).T)
            order = np.argsort(distances, kind="stable")
            self.queue = [int(sample) for sample in order if distances[sample] <= reach]
        told, self.queue = self.queue[: self.PER_TICK], self.queue[self.PER_TICK :]
        return near, [seen((float(samples[one][0]), float(samples[one][1]))) for one in told]


class Wheels:
    """From commands to the speeds at which a robot's own wheels turn, radians per second."""

    TIMER_HZ = 50_000
    FASTEST = 1100
    PER_STEP = 2 * math.pi / 1000

    def __init__(self, lab: Lab, seed: int, robot: int) -> None:
        self.numbers = lab["wheels"]
        self.draws = Draws(seed, 3, robot)
        self.factors = [self.draws.factor(self.numbers["gain"]) for _ in range(2)]
        self.axle_factor = self.draws.factor(self.numbers["gain"])
        self.biases = [self.numbers["bias"] * (self.draws.factor(1.0) - 1.0) for _ in range(2)]

    def turn(self, steps: tuple[int, int]) -> list[float]:
        return [self._speed(*wheel) * self.PER_STEP for wheel in zip(steps, self.factors, self.biases)]

    def _speed(self, steps: int, factor: float, bias: float) -> float:
        size = min(abs(steps), self.FASTEST)
        if size == 0 or size < self.numbers["dead_zone"]:
            return 0.0
        # The motor's timer counts whole ticks.
        timed = math.copysign(self.TIMER_HZ / (self.TIMER_HZ // size), steps) + bias
        return timed * factor * (1.0 + self.draws.normal(self.numbers["noise"]))


class Clock:
    """When a robot thinks."""

    def __init__(self, lab: Lab, seed: int, robot: int) -> None:
        timing, draws = lab["timing"], Draws(seed, 4, robot)
        factor = draws.factor(timing["skew"])
        self.period = timing["tick_s"] * factor
        self.resolution = timing["resolution_s"]
        self.phase = 0.0 if timing["in_phase"] else float(draws.generator.uniform(0.0, self.period))
        self.told = timing["tick_s"]
        self.ticks = 0
        self.before: Optional[float] = None

    def due(self, now: float) -> bool:
        moment = self.phase + self.ticks * self.period
        if self.resolution > 0.0:
            moment = math.ceil(moment / self.resolution - 1e-9) * self.resolution
        return now >= moment - 1e-9

    def tick(self, now: float) -> float:
        """Seconds since the tick before, by the robot's own clock."""
        elapsed = self.told if self.before is None else (now - self.before) * self.told / self.period
        self.ticks += 1
        self.before = now
        return elapsed


@dataclass
class Letter:
    message: grn.Message
    sent: float
    arrives: float


@dataclass
class Radio:
    """Broadcasts on their way to one receiver. The nearest that arrive between two ticks are heard, 8 at most."""

    MOST_HEARD = 8

    numbers: Mapping[str, Any]
    draws: Draws
    losses: Bursts
    on_their_way: list[tuple[Letter, int]] = field(default_factory=list)

    @staticmethod
    def of(lab: Lab, seed: int, robot: int) -> Radio:
        draws = Draws(seed, 5, robot)
        numbers = lab["radio"]
        return Radio(numbers, draws, Bursts(numbers["loss"], numbers["burst_s"], 1.0 / 32.0, draws))

    def fragments(self, message: grn.Message) -> int:
        """How many packets a message takes; each fragment of several carries a header of 2 bytes."""
        length, payload = len(message.pack()), self.numbers["payload_bytes"]
        return 1 if payload == 0 or length <= payload else math.ceil(length / max(1, payload - 2))

    def carry(self, letter: Letter, sender: int, distance: float, blocked: bool) -> None:
        numbers = self.numbers
        reach = numbers["range_m"] * (1.0 + self.draws.normal(numbers["range_noise"]))
        lost = any([self.losses.next() for _ in range(self.fragments(letter.message))])
        if distance <= reach and not blocked and not lost and not self.draws.happens(numbers["corruption"]):
            self.on_their_way.append((letter, sender))

    def hear(self, now: float, distances: Sequence[float]) -> list[tuple[grn.Message, float]]:
        if not self.on_their_way:
            return []
        arrived = [(letter, sender) for letter, sender in self.on_their_way if letter.arrives <= now + 1e-9]
        self.on_their_way = [pair for pair in self.on_their_way if pair not in arrived]
        arrived.sort(key=lambda pair: (distances[pair[1]], pair[1]))
        return [(letter.message, max(0.0, now - letter.sent)) for letter, _ in arrived[: self.MOST_HEARD]]
