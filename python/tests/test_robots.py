import math

import grn
import pytest


@pytest.fixture
def blob(model):
    return grn.Blob.load(model)


def test_a_robot_that_sees_a_target_drives_towards_it(blob):
    for dtype in ("f32", "q8.24"):
        robot = grn.Robot(blob, number=3, dtype=dtype)
        messages = []
        for _ in range(32):
            command = robot.tick(position=(1.0, 2.0), heading=0.0, targets={0: (2.2, 2.0)})
            messages += [command.broadcast] if command.broadcast else []
        left, right = command.steps_per_s
        assert left > 100 and right > 100 and abs(left - right) < 20
        assert command.rad_per_s[0] == pytest.approx(left * 2 * math.pi / 1000)
        assert command.m_per_s[1] == pytest.approx(right * 0.041 * math.pi / 1000)
        assert len(messages) == 4
        assert messages[0].sender == 3 and messages[0].position == pytest.approx((1.0, 2.0), abs=0.02)
        assert messages[-1].target.target == 0 and messages[-1].target.position == pytest.approx((2.2, 2.0), abs=0.002)
        assert 0.0 <= robot.morphogen <= 1.0


def test_what_is_heard_moves_a_robot_that_sees_nothing(blob):
    speaker, listener = grn.Robot(blob, 0), grn.Robot(blob, 1)
    command = None
    for _ in range(64):
        said = speaker.tick(position=[1.0, 2.0], heading=0.0, targets={0: (1.5, 2.0)}).broadcast
        heard = [] if said is None else [(grn.Message.unpack(said.pack()), 0.05)]
        command = listener.tick(position=(0.0, 2.0), heading=0.0, heard=heard)
    assert min(command.steps_per_s) > 100


def test_robots_give_the_bits_of_the_simulator(blob, channel):
    """The first tick of a robot that cannot be told from one of a simulated swarm: at its place, with nothing near."""
    first, second = grn.Robot(blob, 0), grn.Robot(blob, 0)
    for tick in range(200):
        percept = dict(position=(1.0 + tick * 1e-3, 2.0), heading=tick * 0.01, targets={0: (1.4, 2.1)}, obstacles=[(1.0, 2.6)])
        assert first.tick(**percept) == second.tick(**percept)


def test_a_robot_that_is_called_home_drives_there(blob):
    for dtype in ("f32", "q8.24"):
        robot = grn.Robot(blob, 0, dtype=dtype)
        for _ in range(32):
            command = robot.tick(position=(1.0, 2.0), heading=0.0, targets={0: (2.2, 2.0)}, home=(-20.0, 2.0))
        assert max(command.steps_per_s) < -100
    with pytest.raises(ValueError, match="home"):
        robot.tick(position=(1.0, 2.0), heading=0.0, home=(40.0, 0.0))


def test_a_robot_without_a_pose_stops_in_the_end(blob):
    robot = grn.Robot(blob, 0)
    for _ in range(32):
        command = robot.tick(position=(1.0, 2.0), heading=0.0, targets={0: (2.2, 2.0)})
    assert command.steps_per_s != (0, 0)
    for _ in range(32):
        command = robot.tick()
    assert command.steps_per_s == (0, 0)


@pytest.mark.parametrize(
    ("percept", "text"),
    [
        ({"position": (1.0, 2.0)}, "belong together"),
        ({"position": (1.0, 2.0, 3.0), "heading": 0.0}, "two numbers"),
        ({"position": (1.0, math.nan), "heading": 0.0}, "two numbers"),
        ({"position": (40.0, 0.0), "heading": 0.0}, "position = 40"),
        ({"position": (1.0, 2.0), "heading": math.inf}, "radians"),
        ({"position": (1.0, 2.0), "heading": 0.0, "pose_age": -1.0}, "pose_age = -1"),
        ({"elapsed": 0.0}, "0 µs"),
        ({"proximity": [None] * 7}, "proximity has 7"),
        ({"proximity": [-0.1] + [None] * 7}, "-0.1"),
        ({"targets": {number: (0.0, 0.0) for number in range(5)}}, "at most 4"),
        ({"targets": {0: (1.0, 50.0)}}, "targets = 50"),
        ({"obstacles": [(0.0, 0.0)] * 9}, "at most 8"),
        ({"heard": ["hello"]}, "hello is neither"),
    ],
)
def test_impossible_percepts_are_refused(blob, percept, text):
    with pytest.raises(grn.GrnError, match=text):
        grn.Robot(blob).tick(**percept)


def test_damaged_messages_are_refused(blob):
    robot = grn.Robot(blob, 7)
    said = next(filter(None, (robot.tick(position=(0.0, 0.0), heading=0.0).broadcast for _ in range(8))))
    data = said.pack()
    assert grn.Message.unpack(data) == said and len(data) <= 37
    with pytest.raises(grn.GrnError, match="damaged"):
        grn.Message.unpack(data[:-1] + bytes([data[-1] ^ 1]))
    with pytest.raises(grn.GrnError, match="2 bytes"):
        grn.Message.unpack(data[:2])


def test_models_without_a_ring_are_refused(root):
    with pytest.raises(grn.GrnError, match="no-pattern|pattern"):
        grn.Robot(grn.Blob.load(root / "host-evolver" / "tests" / "data" / "no-pattern.grn"))
