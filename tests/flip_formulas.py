"""FLIP (Andersson et al. 2020), as the paper has it: filters in two dimensions, one pixel after another."""
import math

PPD = 0.7 * 3840 / 0.7 * math.pi / 180
XYZ = ((0.4123907992659595, 0.35758433938387796, 0.1804807884018343),
       (0.21263900587151036, 0.7151686787677559, 0.07219231536073371),
       (0.01933081871559185, 0.11919477979462599, 0.9505321522496607))
WHITE = [sum(row) for row in XYZ]


def times(matrix, v):
    return [sum(a * b for a, b in zip(row, v)) for row in matrix]


def inverse(m):
    (a, b, c), (d, e, f), (g, h, i) = m
    det = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    return [[(e * i - f * h) / det, (c * h - b * i) / det, (b * f - c * e) / det],
            [(f * g - d * i) / det, (a * i - c * g) / det, (c * d - a * f) / det],
            [(d * h - e * g) / det, (b * g - a * h) / det, (a * e - b * d) / det]]


RGB = inverse(XYZ)


def lab(rgb):
    def f(t):
        return t ** (1 / 3) if t > (6 / 29) ** 3 else t / (3 * (6 / 29) ** 2) + 4 / 29
    x, y, z = (f(v / w) for v, w in zip(times(XYZ, rgb), WHITE))
    lightness = 116 * y - 16
    return lightness, 0.01 * lightness * 500 * (x - y), 0.01 * lightness * 200 * (y - z)


def hyab(a, b):
    return abs(a[0] - b[0]) + math.hypot(a[1] - b[1], a[2] - b[2])


def kernel(radius, weight):
    return {(x, y): weight(x, y) for y in range(-radius, radius + 1) for x in range(-radius, radius + 1)}


def eye_kernel(terms):
    radius = math.ceil(3 * math.sqrt(0.04 / (2 * math.pi ** 2)) * PPD)
    k = kernel(radius, lambda x, y: sum(a * math.sqrt(math.pi / b) * math.exp(-math.pi ** 2 * (x * x + y * y) /
                                                                              (PPD * PPD * b)) for a, b in terms))
    total = sum(k.values())
    return {at: value / total for at, value in k.items()}


def feature_kernel(weight):
    sd = 0.5 * 0.082 * PPD
    k = kernel(math.ceil(3 * sd), lambda x, y: weight(x, y, sd) * math.exp(-(x * x + y * y) / (2 * sd * sd)))
    above, below = sum(v for v in k.values() if v > 0), -sum(v for v in k.values() if v < 0)
    return {at: value / (above if value > 0 else below) for at, value in k.items()}


def filtered(plane, width, height, k):
    out = []
    for y in range(height):
        for x in range(width):
            out.append(sum(w * plane[min(max(y + j, 0), height - 1) * width + min(max(x + i, 0), width - 1)]
                           for (i, j), w in k.items()))
    return out


def seen(pixels, width, height):
    xyz = [[v / w for v, w in zip(times(XYZ, p), WHITE)] for p in pixels]
    planes = [[116 * v[1] - 16 for v in xyz], [500 * (v[0] - v[1]) for v in xyz], [200 * (v[1] - v[2]) for v in xyz]]
    terms = ([(1, 0.0047)], [(1, 0.0053)], [(34.1, 0.04), (13.5, 0.025)])
    blurred = [filtered(plane, width, height, eye_kernel(t)) for plane, t in zip(planes, terms)]
    colours = []
    for l, cx, cz in zip(*blurred):
        y = (l + 16) / 116
        rgb = times(RGB, [v * w for v, w in zip((y + cx / 500, y, y - cz / 200), WHITE)])
        colours.append(lab([min(max(v, 0), 1) for v in rgb]))
    light = [(l + 16) / 116 for l in planes[0]]
    features = []
    for weight in (lambda x, y, sd: -x, lambda x, y, sd: x * x / sd ** 2 - 1):
        by_x = filtered(light, width, height, feature_kernel(weight))
        by_y = filtered(light, width, height, feature_kernel(lambda x, y, sd: weight(y, x, sd)))
        features.append([math.hypot(a, b) for a, b in zip(by_x, by_y)])
    return colours, features


def flip(a, b, width, height):
    (colours_a, features_a), (colours_b, features_b) = seen(a, width, height), seen(b, width, height)
    largest, total = hyab(lab((0, 1, 0)), lab((0, 0, 1))) ** 0.7, 0
    for i in range(width * height):
        e, split = hyab(colours_a[i], colours_b[i]) ** 0.7, 0.4 * largest
        colour = 0.95 / split * e if e < split else 0.95 + (e - split) / (largest - split) * 0.05
        feature = max(abs(fa[i] - fb[i]) for fa, fb in zip(features_a, features_b))
        total += colour ** (1 - (feature / math.sqrt(2)) ** 0.5)
    return total / (width * height)
