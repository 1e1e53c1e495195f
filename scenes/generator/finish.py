"""The finish of each look: its picture, how the picture lies on it, and its gloss.

Texture coordinates are linear in a vertex's place in its mesh, so that no vertex needs a second pair. Of a box, each
projection leaves no side without area: `wall` suits upright surfaces, `ground` level ones."""

WALL = ((1, 0, 1), (0.35, -1, -0.35))      # (u, v) = rows x (x, y, z)
GROUND = ((1, 1, 0.06), (0.06, 1, 1))
ALONG_X = ((1, 0.3, 0.3), (0, 1, 1))


class Finish:
    def __init__(self, picture=None, metres=1.0, lies=WALL, metallic=0.0, roughness=0.9):
        self.picture, self.metallic, self.roughness = picture, metallic, roughness
        self.rows = [[round(c / metres, 6) for c in row] for row in lies]

    def coordinates(self, positions):
        return [tuple(sum(c * x for c, x in zip(row, p)) for row in self.rows) for p in positions]


MATT = Finish()
FINISHES = {
    "asphalt": Finish("asphalt", 3.0, GROUND), "paving": Finish("stone", 2.0, GROUND), "kerb": Finish("stone", 1.5, GROUND),
    "gate": Finish("stone", 3.0), "trim stone": Finish("stone", 2.0), "stone": Finish("stone", 2.0, roughness=0.6),
    "block": Finish("stone", 1.5, roughness=0.25), "slab light": Finish("stone", 1.2, GROUND),
    "slab": Finish("stone", 1.2, GROUND), "slab dark": Finish("stone", 1.2, GROUND), "arcade": Finish("stone", 2.0),
    "column": Finish("stone", 1.5), "pale tile": Finish("stone", 2.0, GROUND, roughness=0.4),
    "dark tile": Finish("stone", 2.0, GROUND, roughness=0.35), "back wall": Finish("bricks", 1.6),
    "wall": Finish("plaster", 3.0), "plaster": Finish("plaster", 3.0), "ceiling": Finish("plaster", 3.0, GROUND),
    "rose wall": Finish("bricks", 1.6), "ochre wall": Finish("plaster", 3.0), "cream wall": Finish("plaster", 3.0),
    "sage wall": Finish("plaster", 3.0), "slate wall": Finish("bricks", 1.6), "wood": Finish("wood", 1.2, ALONG_X, roughness=0.6),
    "skirting": Finish("wood", 1.5, ALONG_X, roughness=0.5), "bark": Finish("wood", 0.8), "shutter": Finish("wood", 0.9, roughness=0.7),
    "tile": Finish("bricks", 1.2, GROUND), "soil": Finish("asphalt", 1.0, GROUND), "pot": Finish("plaster", 1.0, roughness=0.7),
    "iron": Finish(metallic=1.0, roughness=0.55), "glass": Finish(roughness=0.12), "frame": Finish(metallic=0.6, roughness=0.4),
    "robot joint": Finish(metallic=0.9, roughness=0.45), "robot shell 0": Finish(roughness=0.4),
    "robot shell 1": Finish(roughness=0.4), "robot trim 0": Finish(roughness=0.5), "robot trim 1": Finish(roughness=0.5),
    "shards": Finish(roughness=0.45),
    "steel": Finish(metallic=1.0, roughness=0.22), "brass": Finish(metallic=1.0, roughness=0.3),
}


def of(name):
    return FINISHES.get(name, MATT)
