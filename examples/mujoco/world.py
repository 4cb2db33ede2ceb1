"""A scenario and its robots as a MuJoCo model.

Choices, and why:

- An e-puck2 is a cylinder of 130 g on two driven wheels and two smooth casters, with the measures of the data sheet: 70 mm
  across, wheels of 41 mm, 53 mm apart. Its mass lies low, so that it does not tip when it brakes.
- Wheels and casters are spheres inside the body: each touches the floor in one point, as the real ones do, and
  nothing but the floor, so that what robots bump into each other and into walls with is the cylinder alone.
- Casters have priority over the floor: in a contact MuJoCo takes the greater friction of the two otherwise, and they would rub.
- Steppers do not yield below their torque: each wheel is a velocity servo with a time constant of some milliseconds and at
  most 30 mN m. A geared motor's rotor weighs more at the wheel than the wheel itself; without it (`armature`) the servo and
  the friction of so light a wheel fight each other, and robots jerk.
- The physics step is 1/256 s, 8 steps in a control tick of 1/32 s, and the floor is stiff (`solref` of two steps). A robot that
  weaves for ten seconds then is 0.3 mm from where its wheels should have taken it; with steps of 1/128 s it is 0.7 mm.
- A wall is a row of boxes along the edges of its polygon, inside it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Sequence
from xml.etree import ElementTree

import grn
import mujoco
import numpy as np

BODY_RADIUS = 0.035
BODY_HEIGHT = 0.045
MASS = 0.13
WHEEL_MASS = 0.005
AXLE = 0.053
WHEEL_DIAMETER = 0.041
TORQUE = 0.03
ARMATURE = 1e-4
STEPS_PER_SECOND = 256
WALL_THICKNESS = 0.02
WALL_HEIGHT = 0.1
PROXIMITY_RANGE = 0.05
RAY_HEIGHT = 0.025
# Geoms that bodies bump into and rays meet.
SOLID = 1


@dataclass
class World:
    """The model with the places of what the loop needs."""

    model: mujoco.MjModel
    data: mujoco.MjData
    robots: int
    bodies: np.ndarray
    is_robot: np.ndarray
    is_wall: np.ndarray

    def positions(self) -> np.ndarray:
        """Centres of the robots, robots x 2, metres."""
        return self.data.xpos[self.bodies, :2].copy()

    def headings(self) -> np.ndarray:
        """Radians."""
        forward = self.data.xmat[self.bodies].reshape(-1, 3, 3)[:, :, 0]
        return np.arctan2(forward[:, 1], forward[:, 0])

    def drive(self, robot: int, left: float, right: float) -> None:
        """Sets the wheels' speeds, radians per second."""
        self.data.ctrl[2 * robot : 2 * robot + 2] = (left, right)

    def place_targets(self, places: Sequence[tuple[float, float]]) -> None:
        """Moves targets that have a body."""
        if self.model.nmocap:
            self.data.mocap_pos[:, :2] = places

    def ray(self, start: tuple[float, float], way: tuple[float, float], robot: int) -> float:
        """Metres from `start` along the unit vector `way` to the first wall or robot other than `robot`; infinite if none."""
        groups = np.zeros(6, np.uint8)
        groups[SOLID] = 1
        met = np.array([-1], np.int32)
        point = np.array([*start, RAY_HEIGHT])
        distance = mujoco.mj_ray(
            self.model, self.data, point, np.array([*way, 0.0]), groups, 1, int(self.bodies[robot]), met
        )
        return distance if met[0] >= 0 else math.inf

    def touching(self) -> tuple[set[tuple[int, int]], set[int]]:
        """Pairs of robots, and robots at walls, that touch."""
        geoms = self.data.contact.geom
        # The floor is the first geom, and what touches it is nothing that counts.
        geoms = geoms[geoms.min(axis=1) > 0] if len(geoms) else geoms
        if not len(geoms):
            return set(), set()
        robots, walls = self.is_robot[geoms], self.is_wall[geoms]
        pairs = {(int(min(a, b)), int(max(a, b))) for a, b in robots[(robots >= 0).all(axis=1)]}
        at_walls = (robots >= 0).any(axis=1) & walls.any(axis=1)
        return pairs, {int(robot) for robot in robots[at_walls].max(axis=1)}


def build(
    scenario: grn.Scenario,
    positions: np.ndarray,
    headings: np.ndarray,
    axle_factors: Sequence[float],
    target_radius: float = 0.0,
) -> World:
    """A world of a scenario that is scaled to metres, with robots at rest at these poses."""
    root = ElementTree.Element("mujoco", model=scenario.name)
    ElementTree.SubElement(
        root,
        "option",
        timestep=repr(1 / STEPS_PER_SECOND),
        integrator="implicitfast",
    )
    world = ElementTree.SubElement(root, "worldbody")
    east, north = scenario.region
    floor = {"name": "floor", "type": "plane", "size": f"{east + north} {east + north} 1", "pos": "0 0 0"}
    ElementTree.SubElement(world, "geom", floor, friction="1 0 0", contype="1", conaffinity="1", solref="0.008 1")
    for number, corners in enumerate(scenario.walls):
        for edge, box in enumerate(_boxes(corners)):
            solid = {"group": str(SOLID), "contype": "2", "conaffinity": "2", "friction": "0.3 0 0"}
            ElementTree.SubElement(world, "geom", box, **solid, name=f"wall-{number}-{edge}", type="box")
    if target_radius > 0.0:
        for number, place in enumerate(scenario.targets_at(0.0)):
            if place is None:
                continue
            x, y = place
            body = ElementTree.SubElement(world, "body", name=f"target-{number}", mocap="true", pos=f"{x} {y} 0.05")
            size = {"type": "cylinder", "size": f"{target_radius} 0.05", "group": str(SOLID)}
            ElementTree.SubElement(body, "geom", size, contype="2", conaffinity="2", friction="0.3 0 0")
    actuators = ElementTree.SubElement(root, "actuator")
    for robot, (position, heading, factor) in enumerate(zip(positions, headings, axle_factors)):
        _robot(world, actuators, robot, position, float(heading), AXLE * factor)
    model = mujoco.MjModel.from_xml_string(ElementTree.tostring(root, encoding="unicode"))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    count = len(positions)
    bodies = np.array([model.body(f"robot-{robot}").id for robot in range(count)])
    is_robot = np.full(model.ngeom, -1)
    is_robot[[model.geom(f"body-{robot}").id for robot in range(count)]] = range(count)
    is_wall = np.array([model.geom(geom).name.startswith("wall-") for geom in range(model.ngeom)])
    return World(model, data, count, bodies, is_robot, is_wall)


def _robot(
    world: ElementTree.Element,
    actuators: ElementTree.Element,
    robot: int,
    position: np.ndarray,
    heading: float,
    axle: float,
) -> None:
    radius = WHEEL_DIAMETER / 2
    turned = f"{math.cos(heading / 2)} 0 0 {math.sin(heading / 2)}"
    place = {"pos": f"{position[0]} {position[1]} 0", "quat": turned}
    body = ElementTree.SubElement(world, "body", place, name=f"robot-{robot}")
    ElementTree.SubElement(body, "freejoint")
    bottom = 0.004
    shape = {
        "name": f"body-{robot}",
        "type": "cylinder",
        "size": f"{BODY_RADIUS} {BODY_HEIGHT / 2}",
        "pos": f"0 0 {bottom + BODY_HEIGHT / 2}",
        "mass": "0",
    }
    solid = {"group": str(SOLID), "contype": "2", "conaffinity": "2", "friction": "0.3 0 0"}
    ElementTree.SubElement(body, "geom", shape, **solid)
    # A solid cylinder's moments, with its centre at the height of the batteries.
    mass = MASS - 2 * WHEEL_MASS
    about_axis = mass * BODY_RADIUS**2 / 2
    across = mass * (3 * BODY_RADIUS**2 + BODY_HEIGHT**2) / 12
    inertia = {"pos": "0 0 0.015", "mass": str(mass), "diaginertia": f"{across} {across} {about_axis}"}
    ElementTree.SubElement(body, "inertial", inertia)
    for x in (-0.028, 0.028):
        caster = {"type": "sphere", "size": "0.004", "pos": f"{x} 0 0.0041", "mass": "0", "condim": "1", "priority": "1"}
        ElementTree.SubElement(body, "geom", caster, contype="0", conaffinity="1", group="2")
    for side, y in (("left", axle / 2), ("right", -axle / 2)):
        wheel = ElementTree.SubElement(body, "body", name=f"{side}-{robot}", pos=f"0 {y} {radius}")
        ElementTree.SubElement(wheel, "joint", name=f"{side}-{robot}", type="hinge", axis="0 1 0", armature=str(ARMATURE))
        tyre = {"type": "sphere", "size": str(radius), "mass": str(WHEEL_MASS), "friction": "1 0 0", "group": "2"}
        ElementTree.SubElement(wheel, "geom", tyre, contype="0", conaffinity="1")
        servo = {"joint": f"{side}-{robot}", "kv": "0.02", "forcerange": f"{-TORQUE} {TORQUE}", "forcelimited": "true"}
        ElementTree.SubElement(actuators, "velocity", servo)


def _boxes(corners: Sequence[tuple[float, float]]) -> list[dict[str, str]]:
    following = list(corners[1:]) + [corners[0]]
    area = sum(x0 * y1 - x1 * y0 for (x0, y0), (x1, y1) in zip(corners, following))
    inwards = 1.0 if area > 0 else -1.0
    boxes = []
    for (x0, y0), (x1, y1) in zip(corners, following):
        length = math.hypot(x1 - x0, y1 - y0)
        east, north = (x1 - x0) / length, (y1 - y0) / length
        half = WALL_THICKNESS / 2
        x = (x0 + x1) / 2 - north * half * inwards
        y = (y0 + y1) / 2 + east * half * inwards
        angle = math.atan2(north, east) / 2
        boxes.append(
            {
                "size": f"{length / 2} {half} {WALL_HEIGHT / 2}",
                "pos": f"{x} {y} {WALL_HEIGHT / 2}",
                "quat": f"{math.cos(angle)} 0 0 {math.sin(angle)}",
            }
        )
    return boxes
