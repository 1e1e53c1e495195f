#!/usr/bin/env python3
"""Holds the sources to the layers of docs/architecture.md: who may include whom, and where machinery may be named.

usage: layers_test.py ROOT        (prints each breach with its line; exit code 1 if there is one)
"""
import pathlib
import re
import sys

# Folders of src, by the folders that each may include beside itself. The public headers, include/tenebra, stand
# below all of them: any file may include one.
MAY_INCLUDE = {
    "base": set(),
    "math": {"base"},
    "io": {"base"},
    "parallel": {"base"},
    "simd": {"base"},
    "trees": {"base", "math", "simd", "parallel"},
    "scene": {"base", "math"},
    "formats": {"base", "io", "math", "scene"},
    "texture": {"base", "math", "simd", "scene"},
    "stage": {"base", "io", "math", "parallel", "scene", "texture"},
    "points": {"base", "math", "simd", "parallel", "scene"},
    "shadow": {"base", "math", "simd", "parallel", "scene", "points"},
    "soft": {"base", "math", "simd", "parallel", "scene", "points"},  # and hard shadows by their public header
    "tint": {"base", "math", "simd", "parallel", "scene", "texture", "points", "shadow", "soft", "trees"},
    "ao": {"base", "io", "math", "simd", "parallel", "scene", "texture", "points", "trees"},
    "query": {"base", "math", "parallel", "scene", "points"},  # and the tracers by their public headers
    "host": {"base"},
    "c_api": {"base"},
    "shade": {"base", "io", "math", "simd", "parallel", "scene", "texture", "points"},
    "oracle": {"base", "parallel"},
    "gl": {"base"},
    "visibility": {"base", "math", "simd", "parallel", "scene"},
    "shade_gl": {"base", "io", "math", "parallel", "scene", "gl", "shade"},
    "raster": {"base", "math", "scene", "gl", "visibility"},
    "render": {"base", "io", "math", "simd", "parallel", "scene", "formats", "points", "shadow", "soft", "ao", "tint", "gl", "raster", "visibility", "texture", "shade", "shade_gl"},
    "settings": {"base", "io", "scene", "formats", "gl", "shade", "stage", "render"},
    "session": {"base", "io", "scene", "formats", "shade", "stage", "render", "settings"},
    "bake": {"base", "math", "parallel", "scene", "points", "soft", "shade", "render"},
    "sun": {"base", "io", "math", "parallel", "scene", "points", "formats"},  # and points of one's own and tints by their public headers
}

# Rooms of a folder, lowest first: a room includes itself and rooms before it. "" is the folder's own files.
ROOMS = {
    "io": ["", "exr"],
    "stage": ["cutout", "edits", ""],
    "formats": ["", "gltf_check", "images", "obj", "ply", "stl", "aff", "gltf", "glb", "assimp"],
    "shadow": ["decision", "rays", "cone_tree", "tiles", ""],
    "soft": ["memory", "light", "polygon", "groups", "shafts", "occluders", "clip", "silhouette", "bsp", "solve", "sample", ""],
    "ao": ["objects", "cast", "cache", "receivers", "casters", "adaptive", "reference", "field", "surface", "presampled", ""],
}
FORMATS = ("obj", "ply", "stl", "aff", "gltf", "glb", "assimp")  # its readers and the writer
APART = {("edits", "cutout"), ("tiles", "cone_tree"), ("silhouette", "clip"), ("bsp", "clip"), ("bsp", "silhouette"),
         ("reference", "adaptive"), ("field", "adaptive"), ("surface", "adaptive"), ("presampled", "adaptive"),
         ("field", "reference"), ("surface", "reference"), ("presampled", "reference"),
         *((a, b) for a in FORMATS for b in FORMATS if a != b)}  # may not see each other

# What may be named where: (pattern, what it is, folders, rooms or files that may).
CONTAINED = [
    (r"\b_mm\w*\(|immintrin", "an intrinsic", {"simd", "parallel"}),  # parallel: the floating-point environment
    (r"\bhn::|hwy::HWY_NAMESPACE", "a vector register", {"simd"}),
    (r"\bstd::(thread|jthread|mutex|atomic|condition_variable|barrier)\b|\btbb::", "a thread", {"parallel", "gl/load_functions.cpp"}),  # gl: glad's one table for all threads
    (r"\bgl[A-Z]\w*\(", "an OpenGL call", {"gl", "raster", "shade_gl"}),
    (r"tiny_gltf|tinygltf::", "tinygltf", {"formats/gltf"}),
    (r"\bmeshopt_|meshoptimizer\.h", "meshoptimizer", {"formats/gltf/meshopt.cpp"}),
    (r"\bdraco::|<draco/", "Draco", {"formats/gltf/draco_decoder.cpp"}),
    (r"\bAssimp::|assimp/scene", "Assimp", set()),  # in converter alone
    (r"\bstbi_|stb/stb_image", "stb_image", {"io/image.cpp"}),
    (r"\bImf\b|\bImath\b|Imf\w*\.h|Imath\w*\.h", "OpenEXR", {"io/exr/exr_file.cpp"}),
    (r"libdeflate", "libdeflate", {"io/png_writer.cpp", "io/png_structure.cpp"}),
    (r"\bktx[A-Z]|<ktx\.h>", "libktx", {"formats/images/ktx2.cpp"}),
    (r"\bWebP[A-Z]|webp/", "libwebp", {"formats/images/webp.cpp"}),
    (r"\bImGui|GLFW", "the window", set()),
    (r"\brtc[A-Z]\w*\(|embree", "the ray caster", {"ao/reference/embree.h", "ao/reference/reference_rays.cpp"}),
]


# Rooms of the program, lowest first, as above; main.cpp stands above them all.
VIEWER_ROOMS = ["shell", "options", "shared", "log", "trade", "window", "commands", ""]
# Rooms of viewer/window that know nothing of what is drawn: of the window they see themselves and these.
PLAIN_WINDOW_ROOMS = {"motion": set(), "frames": {"motion"}}

# The same for the program: folders or files below viewer/ that may name it.
CONTAINED_IN_VIEWER = [
    (r"\bImGui\b|imgui|GLFW|glfw", "the window", ("window/",)),
    (r"GLFW|glfw[A-Z3]", "GLFW", ("window/glfw_window.cpp",)),
    (r"\bstd::(thread|jthread|mutex|atomic|condition_variable|barrier)\b", "a thread", ("window/frames/render_worker.", "window/frames/explainer.", "window/frames/one_job.", "shell/stop_signals.", "shell/draw_limit.", "shell/last_words.")),
    (r"\bgl[A-Z]\w*\(", "an OpenGL call", ()),
]


def viewer_breaches(root):
    for path in sorted((root / "viewer").rglob("*.*")):
        name = path.relative_to(root / "viewer").as_posix()
        room = name.split("/")[0] if "/" in name else ""
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            other = re.match(r'\s*#include "(\w+)/', line)
            if other and VIEWER_ROOMS.index(room) < (VIEWER_ROOMS.index(other[1]) if other[1] in VIEWER_ROOMS else 0):
                yield f"viewer/{name}:{number}: viewer/{room} may not include viewer/{other[1]}"
            why = window_breach(name, line)
            if why:
                yield f"viewer/{name}:{number}: {why}"
            code = line.split("//")[0]
            for pattern, what, places in CONTAINED_IN_VIEWER:
                if re.search(pattern, code) and "window/glfw_window.h" not in code and not name.startswith(places):
                    yield f"viewer/{name}:{number}: names {what}, allowed only in {places or 'src/gl, src/raster and src/shade_gl'}"


def window_breach(name, line):
    """Why a file of a plain room of viewer/window may not hold `line`, or None."""
    parts = name.split("/")
    room = parts[1] if parts[0] == "window" and len(parts) > 2 else ""
    if room not in PLAIN_WINDOW_ROOMS:
        return None
    if re.search(r"\bImGui\b|imgui", line.split("//")[0]):
        return f"window/{room} may not name what is drawn"
    include = re.match(r'\s*#include "window/(?:(\w+)/)?', line)
    other = include and (include[1] or "")
    if include and other != room and other not in PLAIN_WINDOW_ROOMS[room]:
        return f"window/{room} may not include {f'window/{other}' if other else 'files of the window itself'}"
    return None


def include_breach(folder, room, line):
    """Why a file of `room` in `folder` may not hold `line`, or None."""
    include = re.match(r'\s*#include "(\w+)/(?:(\w+)/)?', line)
    if not include:
        return None
    other, other_room = include.group(1), include.group(2) or ""
    if other != folder:
        return None if other in MAY_INCLUDE[folder] else f"{folder} may not include {other}"
    rooms = ROOMS.get(folder)
    if rooms is None:
        return None
    if other_room not in rooms:
        return f"{folder} has no room {other_room or 'of its own files'}"
    if rooms.index(other_room) > rooms.index(room) or (room, other_room) in APART:
        return f"{folder}/{room} may not include {folder}/{other_room}"
    return None


def source_breaches(root, path):
    parts = path.relative_to(root / "src").parts
    folder, room = parts[0], parts[1] if len(parts) > 2 else ""
    places = {folder, f"{folder}/{room}", "/".join(parts)}
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        where = f"{path.relative_to(root)}:{number}"
        why = include_breach(folder, room, line)
        if why:
            yield f"{where}: {why}"
        # One namespace a folder. A .cpp may also define what a public header declares.
        space = re.match(r"namespace tenebra(?:::(\w+))?\b", line)
        if space and space.group(1) != folder and (path.suffix == ".h" or space.group(1)):
            yield f"{where}: expected namespace tenebra::{folder}"
        code = line.split("//")[0]
        for pattern, what, allowed in CONTAINED:
            if not places & allowed and re.search(pattern, code):
                yield f"{where}: names {what}, allowed only in {sorted(allowed) or 'viewer/window'}"


def public_breaches(root):
    for path in sorted((root / "include" / "tenebra").glob("*.h")):
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            include = re.match(r'\s*#include ["<]([^">]+)', line)
            if include and "/" in include.group(1) and not include.group(1).startswith(("tenebra/", "glm/", "tl/")):
                yield f"{path.relative_to(root)}:{number}: a public header may not include {include.group(1)}"


def breaches(root):
    yield from viewer_breaches(root)
    yield from public_breaches(root)
    for path in sorted((root / "src").rglob("*.*")):
        if path.suffix in (".h", ".cpp"):
            yield from source_breaches(root, path)


def main():
    found = list(breaches(pathlib.Path(sys.argv[1])))
    print("\n".join(found) or "layers hold")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
