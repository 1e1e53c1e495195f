"""Triangle surfaces and the shapes the scenes are made of. Counter-clockwise seen from outside, closed unless said
otherwise, no triangle without area. A surface without normals is flat-shaded."""

import math

from . import vector as v


class Surface:
    """Positions, triangles as index triples, and unit normals (one for each position) or none."""

    def __init__(self, positions=(), triangles=(), normals=()):
        self.positions = list(positions)
        self.triangles = list(triangles)
        self.normals = list(normals)

    def append(self, other):
        """Adds `other`; both are smooth or both are flat."""
        assert not self.positions or bool(self.normals) == bool(other.normals)
        first = len(self.positions)
        self.positions += other.positions
        self.normals += other.normals
        self.triangles += [(a + first, b + first, c + first) for a, b, c in other.triangles]
        return self

    def quad(self, a, b, c, d):
        self.triangles += [(a, b, c), (a, c, d)]

    def moved(self, offset):
        return Surface([v.add(p, offset) for p in self.positions], self.triangles, self.normals)

    def turned(self, rotation):
        return Surface([v.rotate(rotation, p) for p in self.positions], self.triangles,
                       [v.rotate(rotation, n) for n in self.normals])

    def turned_y(self, angle):
        return self.turned(v.axis_angle((0, 1, 0), angle))


def joined(surfaces):
    result = Surface()
    for surface in surfaces:
        result.append(surface)
    return result


class Model:
    """Surfaces sorted by material name (flat and smooth apart), to become one glTF mesh."""

    def __init__(self):
        self.parts = {}

    def add(self, material, *surfaces):
        for surface in surfaces:
            key = (material, bool(surface.normals))
            self.parts.setdefault(key, Surface()).append(surface)
        return self

    def add_model(self, other, transform):
        for (material, _), surface in other.parts.items():
            self.add(material, transform(surface))
        return self

    def to_mesh(self, document, name, materials, extras=None):
        parts = [(surface, materials[material]) for (material, _), surface in self.parts.items()]
        return document.mesh(name, parts, extras)


# Boxes and prisms

BOX_QUADS = ((1, 5, 7, 3), (4, 0, 2, 6), (2, 3, 7, 6), (0, 4, 5, 1), (4, 6, 7, 5), (0, 1, 3, 2))


def box(low, high):
    """The box between two corners. Vertex index bits: x 4, y 2, z 1."""
    corners = [(x, y, z) for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])]
    surface = Surface(corners)
    for quad in BOX_QUADS:
        surface.quad(*quad)
    return surface


def box_on(centre, size):
    """A box standing on the point `centre`: the middle of its bottom."""
    x, y, z = centre
    w, h, d = size
    return box((x - w / 2, y, z - d / 2), (x + w / 2, y + h, z + d / 2))


def chamfered_box(low, high, bevel):
    """A box with its edges and corners cut at 45 degrees."""
    middle, half = v.mix(low, high, 0.5), v.scale(v.sub(high, low), 0.5)
    surface, index = Surface(), {}
    signs = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    for corner in signs:
        for axis in range(3):  # the corner's vertex on the face across `axis`
            index[corner, axis] = len(surface.positions)
            surface.positions.append(tuple(
                middle[i] + corner[i] * (half[i] - (0.0 if i == axis else bevel)) for i in range(3)))
    for axis in range(3):
        _chamfer_faces(surface, index, signs, axis)
    for corner in signs:
        _add_outward(surface, [index[corner, axis] for axis in range(3)], corner)
    return surface


def _chamfer_faces(surface, index, signs, axis):
    """The two faces across `axis` and the four edge strips along it."""
    b, c = (axis + 1) % 3, (axis + 2) % 3
    ring = ((-1, -1), (1, -1), (1, 1), (-1, 1))

    def corner(a_sign, b_sign, c_sign):
        return tuple({axis: a_sign, b: b_sign, c: c_sign}[i] for i in range(3))

    for s in (-1, 1):
        _add_outward(surface, [index[corner(s, p, q), axis] for p, q in ring], corner(s, 0, 0))
    for p, q in ring:
        ends = [index[corner(-1, p, q), b], index[corner(1, p, q), b],
                index[corner(1, p, q), c], index[corner(-1, p, q), c]]
        _add_outward(surface, ends, corner(0, p, q))


def _add_outward(surface, loop, outward):
    """Adds a convex polygon, turned so that its normal points along `outward`."""
    a, b, c = (surface.positions[i] for i in loop[:3])
    if v.dot(v.cross(v.sub(b, a), v.sub(c, a)), outward) < 0:
        loop = loop[::-1]
    surface.triangles += [(loop[0], loop[i], loop[i + 1]) for i in range(1, len(loop) - 1)]


def extruded_strip(lower, upper, z_back, z_front):
    """The solid between two lines of (x, y) points with the same ascending x, extruded along z: arches, gables.
    The lines may meet at their ends."""
    count = len(lower)
    surface = Surface([(x, y, z) for z in (z_back, z_front) for line in (lower, upper) for x, y in line])

    def at(front, top, i):
        return (2 * front + top) * count + i

    for i in range(count - 1):
        j = i + 1
        _quad_with_area(surface, at(1, 0, i), at(1, 0, j), at(1, 1, j), at(1, 1, i))
        _quad_with_area(surface, at(0, 0, j), at(0, 0, i), at(0, 1, i), at(0, 1, j))
        surface.quad(at(1, 1, i), at(1, 1, j), at(0, 1, j), at(0, 1, i))
        surface.quad(at(0, 0, i), at(0, 0, j), at(1, 0, j), at(1, 0, i))
    for i, order in ((0, (0, 1)), (count - 1, (1, 0))):
        if lower[i] != upper[i]:
            surface.quad(at(order[0], 0, i), at(order[1], 0, i), at(order[1], 1, i), at(order[0], 1, i))
    return surface


def _quad_with_area(surface, a, b, c, d):
    """A quad two of whose neighbouring corners may coincide."""
    p = surface.positions
    surface.triangles += [t for t in ((a, b, c), (a, c, d)) if len({p[i] for i in t}) == 3]


def panel(origin, along_x, along_y):
    """One rectangle, open: it faces along_x x along_y."""
    corners = [origin, v.add(origin, along_x), v.add(v.add(origin, along_x), along_y), v.add(origin, along_y)]
    return Surface(corners, [(0, 1, 2), (0, 2, 3)])


# Round things

def lathe(profile, sides, smooth=True):
    """Turns a line of (radius, y), rising on the outside, about the y axis. Radius 0 closes an end; a corner
    of the smooth line is kept sharp by giving its point twice."""
    rings = list(zip(profile, _profile_normals(profile)))
    surface = Surface()
    for (radius, y), (nr, ny) in rings:
        for s in range(sides):
            a = 2 * math.pi * s / sides
            surface.positions.append((radius * math.sin(a), y, radius * math.cos(a)))
            if smooth:
                surface.normals.append((nr * math.sin(a), ny, nr * math.cos(a)))
    for i in range(len(profile) - 1):
        if profile[i] != profile[i + 1]:
            _lathe_band(surface, profile, i, sides)
    return surface


def _lathe_band(surface, profile, i, sides):
    for s in range(sides):
        t = (s + 1) % sides
        a, b, c, d = i * sides + s, i * sides + t, (i + 1) * sides + t, (i + 1) * sides + s
        if profile[i][0] > 0:
            surface.triangles.append((a, b, c) if profile[i + 1][0] > 0 else (a, b, d))
        if profile[i + 1][0] > 0:
            surface.triangles.append((a, c, d))


def _profile_normals(profile):
    """Normals of a profile's points: the mean of its two segments, one-sided beside a doubled point."""
    def segment(i):
        if not 0 <= i < len(profile) - 1 or profile[i] == profile[i + 1]:
            return None
        dr, dy = profile[i + 1][0] - profile[i][0], profile[i + 1][1] - profile[i][1]
        size = math.hypot(dr, dy)
        return (dy / size, -dr / size)

    normals = []
    for i in range(len(profile)):
        near = [n for n in (segment(i - 1), segment(i)) if n]
        r, y = sum(n[0] for n in near), sum(n[1] for n in near)
        size = math.hypot(r, y)
        normals.append((r / size, y / size))
    return normals


def cylinder(radius, y0, y1, sides, top_radius=None, smooth=True):
    top = radius if top_radius is None else top_radius
    if not smooth:
        return lathe([(0, y0), (radius, y0), (top, y1), (0, y1)], sides, smooth=False)
    return lathe([(0, y0), (radius, y0), (radius, y0), (top, y1), (top, y1), (0, y1)], sides)


def sphere(radius, sides, rings, centre=(0, 0, 0)):
    profile = [(radius * math.sin(math.pi * i / rings), -radius * math.cos(math.pi * i / rings))
               for i in range(rings + 1)]
    profile[0], profile[-1] = (0.0, -radius), (0.0, radius)
    return lathe(profile, sides).moved(centre)


def tube(points, radii, sides, closed=False, smooth=True):
    """A round tube along `points` with a radius at each; flat caps unless `closed` joins its ends."""
    frames = _tube_frames(points, closed)
    surface = Surface()
    for point, radius, (x, y) in zip(points, radii, frames):
        for s in range(sides):
            a = 2 * math.pi * s / sides
            out = v.add(v.scale(x, math.cos(a)), v.scale(y, math.sin(a)))
            surface.positions.append(v.add(point, v.scale(out, radius)))
            if smooth:
                surface.normals.append(out)
    rings = len(points)
    for i in range(rings if closed else rings - 1):
        j = (i + 1) % rings
        for s in range(sides):
            t = (s + 1) % sides
            surface.quad(i * sides + s, i * sides + t, j * sides + t, j * sides + s)
    if not closed:
        _cap(surface, 0, sides, v.normalize(v.sub(points[0], points[1])), smooth)
        _cap(surface, (rings - 1) * sides, sides, v.normalize(v.sub(points[-1], points[-2])), smooth)
    return surface


def _cap(surface, first, sides, outward, smooth):
    loop = list(range(first, first + sides))
    if smooth:  # its own vertices: the cap is flat
        start = len(surface.positions)
        surface.positions += [surface.positions[i] for i in loop]
        surface.normals += [outward] * sides
        loop = list(range(start, start + sides))
    _add_outward(surface, loop, outward)


def _tube_frames(points, closed):
    """Two unit vectors across the tube at each point, carried along it without a twist."""
    count = len(points)
    tangents = [v.normalize(v.sub(points[(i + 1) % count] if closed else points[min(i + 1, count - 1)],
                                  points[i - 1] if closed else points[max(i - 1, 0)])) for i in range(count)]
    x = v.cross(tangents[0], (0, 0, 1) if abs(tangents[0][2]) < 0.9 else (1, 0, 0))
    frames = []
    for tangent in tangents:
        x = v.normalize(v.sub(x, v.scale(tangent, v.dot(x, tangent))))
        frames.append((x, v.cross(tangent, x)))
    return frames
