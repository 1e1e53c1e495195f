"""A walking robot: rigid parts on a node hierarchy, and a gait whose standing foot stays where it is.

Space of a robot: metres, +z forward, the origin on the ground between the feet."""

import math

from . import surface as s
from . import vector as v

THIGH, SHIN, ANKLE, HIP_WIDTH, HIP_HEIGHT = 0.44, 0.44, 0.11, 0.15, 0.93
STEP_LENGTH, CYCLE_S, KEYS = 0.66, 1.2, 48   # one cycle is two steps
SPEED = 2 * STEP_LENGTH / CYCLE_S            # metres a second
LIFT = 0.13
PARTS = ("pelvis", "torso", "head", "thigh", "shin", "foot", "upper arm", "forearm")


def ball(radius, centre=(0, 0, 0)):
    return s.sphere(radius, 16, 10, centre)


def parts():
    """The models of one robot by name; looks: shell, joint, trim, eye. Each hangs from its joint."""
    return {"pelvis": pelvis(), "torso": torso(), "head": head(), "thigh": limb(THIGH, 0.085, 0.075),
            "shin": limb(SHIN, 0.08, 0.06), "foot": foot(), "upper arm": limb(0.32, 0.065, 0.055),
            "forearm": forearm()}


def pelvis():
    model = s.Model().add("joint", s.chamfered_box((-0.17, -0.09, -0.10), (0.17, 0.11, 0.10), 0.03))
    return model.add("trim", s.cylinder(0.09, 0.08, 0.24, 16))


def torso():
    model = s.Model().add("shell", s.chamfered_box((-0.27, 0.20, -0.16), (0.27, 0.60, 0.16), 0.06),
                          s.chamfered_box((-0.19, 0.0, -0.12), (0.19, 0.21, 0.12), 0.04))
    model.add("trim", s.chamfered_box((-0.16, 0.30, 0.14), (0.16, 0.50, 0.19), 0.02),
              s.chamfered_box((-0.20, 0.16, -0.30), (0.20, 0.54, -0.15), 0.04))
    model.add("eye", s.box((-0.10, 0.42, 0.185), (-0.04, 0.46, 0.196)))
    return model.add("joint", s.cylinder(0.07, 0.58, 0.70, 16))


def head():
    model = s.Model().add("shell", s.chamfered_box((-0.16, 0.0, -0.15), (0.16, 0.27, 0.15), 0.05))
    model.add("joint", s.chamfered_box((-0.13, 0.10, 0.13), (0.13, 0.20, 0.17), 0.015), s.cylinder(0.012, 0.26, 0.44, 8))
    model.add("trim", s.cylinder(0.05, -0.03, 0.03, 12).turned(v.axis_angle((0, 0, 1), math.pi / 2)).moved((0.17, 0.13, 0)),
              s.cylinder(0.05, -0.03, 0.03, 12).turned(v.axis_angle((0, 0, 1), math.pi / 2)).moved((-0.17, 0.13, 0)))
    model.add("eye", s.box((-0.09, 0.13, 0.16), (-0.03, 0.17, 0.176)), s.box((0.03, 0.13, 0.16), (0.09, 0.17, 0.176)))
    return model.add("trim", ball(0.03, (0, 0.45, 0)))


def limb(length, upper, lower):
    model = s.Model().add("joint", ball(upper))
    profile = [(0, -length + 0.05), (lower, -length + 0.05), (lower, -length + 0.05), (upper, -0.06), (upper, -0.06),
               (0, -0.06)]
    return model.add("shell", s.lathe(profile, 16))


def forearm():
    model = limb(0.27, 0.06, 0.05)
    model.add("joint", ball(0.045, (0, -0.25, 0)))
    for x in (-0.03, 0.03):
        model.add("trim", s.chamfered_box((x - 0.015, -0.40, -0.03), (x + 0.015, -0.27, 0.03), 0.008))
    return model


def foot():
    model = s.Model().add("joint", ball(0.062))
    return model.add("trim", s.chamfered_box((-0.08, -ANKLE, -0.11), (0.08, -0.04, 0.20), 0.025))


# The gait

def hip_height(phase):
    """Highest as a leg passes under the body, twice a cycle."""
    return HIP_HEIGHT - 0.018 * math.cos(4 * math.pi * phase)


def ankle_at(phase):
    """(z, y) of an ankle against the body's ground point. It stands over the first half of the cycle, moving back
    as fast as the robot moves on, and swings over the second."""
    phase %= 1.0
    if phase < 0.5:
        return STEP_LENGTH * (0.5 - 2 * phase), ANKLE
    u = 2 * phase - 1
    # The swing leaves and arrives at the speed of the ground, so that the foot does not jerk.
    z = STEP_LENGTH * (-0.5 - u + 6 * u * u - 4 * u ** 3)
    return z, ANKLE + LIFT * math.sin(math.pi * u) ** 2


def leg_angles(phase):
    """Turns about x (thigh, shin, foot) that put the ankle where it belongs; the foot stays level."""
    z, y = ankle_at(phase)
    down = hip_height(phase) - y
    reach = min(math.hypot(z, down), THIGH + SHIN - 1e-4)
    knee = math.acos((reach * reach - THIGH ** 2 - SHIN ** 2) / (2 * THIGH * SHIN))
    lean = math.atan2(z, down)
    thigh = -lean - math.acos((THIGH ** 2 + reach * reach - SHIN ** 2) / (2 * THIGH * reach))
    return thigh, knee, -thigh - knee


class Gait:
    """Key times and values of a robot that walks from 0 to end_s, `shift` cycles ahead."""

    def __init__(self, end_s, shift):
        count = int(math.ceil(end_s / CYCLE_S * KEYS))
        self.times = [i * CYCLE_S / KEYS for i in range(count + 1)]
        self.phases = [t / CYCLE_S + shift for t in self.times]

    def turns_x(self, angle_of):
        return [v.axis_angle((1, 0, 0), angle_of(p)) for p in self.phases]

    def leg(self, shift):
        angles = [leg_angles(p + shift) for p in self.phases]
        return [[v.axis_angle((1, 0, 0), a[i]) for a in angles] for i in range(3)]

    def bob(self):
        return [(0.0, hip_height(p), 0.0) for p in self.phases]


def add_robot(document, name, meshes, gait, start, heading, parent):
    """A robot that walks straight on from `start`, `heading` radians about y. Returns its root node."""
    end_s = gait.times[-1]
    way = v.scale((math.sin(heading), 0.0, math.cos(heading)), SPEED * end_s)
    root = document.node(name, parent, start, v.axis_angle((0, 1, 0), heading))
    document.animate(root, "translation", [0.0, end_s], [start, v.add(start, way)])

    def part(kind, owner, at, turns, side=""):
        label = " ".join(filter(None, (name, side, kind)))
        node = document.node(label, owner, at, turns[0] if turns else None, mesh=meshes[kind])
        if turns:
            document.animate(node, "rotation", gait.times, turns)
        return node

    hips = part("pelvis", root, (0, hip_height(gait.phases[0]), 0), None)
    document.animate(hips, "translation", gait.times, gait.bob())
    sway = [v.axis_angle((0, 1, 0), 0.10 * math.sin(2 * math.pi * p)) for p in gait.phases]
    trunk = part("torso", hips, (0, 0.20, 0), sway)
    part("head", trunk, (0, 0.68, 0), gait.turns_x(lambda p: 0.04 * math.sin(4 * math.pi * p)))
    for side, sign, shift in (("left", 1, 0.0), ("right", -1, 0.5)):
        thigh, shin, foot_turns = gait.leg(shift)
        hip = part("thigh", hips, (sign * HIP_WIDTH, 0, 0), thigh, side)
        knee = part("shin", hip, (0, -THIGH, 0), shin, side)
        part("foot", knee, (0, -SHIN, 0), foot_turns, side)
        swing = gait.turns_x(lambda p, k=shift: 0.42 * math.cos(2 * math.pi * (p + k)) - 0.05)
        arm = part("upper arm", trunk, (sign * 0.345, 0.52, 0), swing, side)
        bend = gait.turns_x(lambda p, k=shift: -0.45 + 0.25 * math.cos(2 * math.pi * (p + k)))
        part("forearm", arm, (0, -0.32, 0), bend, side)
    return root
