#!/usr/bin/env python3
"""Holds the sources to the layers of the README: who may include whom, and where machinery may be named.

usage: layers_test.py ROOT        (prints each breach with its line; exit code 1 if there is one)
"""
import pathlib
import re
import sys

MAY_INCLUDE = {
    "base": {"base"},
    "math": {"base", "math"},
    "parallel": {"base", "parallel"},
    "simd": {"base", "simd"},
    "scene": {"base", "math", "scene"},
    "import": {"base", "math", "scene", "import"},
    "points": {"base", "math", "simd", "parallel", "scene", "points"},
    "shadow": {"base", "math", "simd", "parallel", "scene", "points", "shadow"},
    "soft": {"base", "math", "simd", "parallel", "scene", "points", "soft"},
    "ao": {"base", "math", "simd", "parallel", "scene", "points", "ao"},
    "gl": {"base", "gl"},
    "raster": {"base", "math", "scene", "gl", "raster"},
    "render": {"base", "math", "simd", "parallel", "scene", "import", "points", "shadow", "soft", "ao", "gl", "raster",
               "render"},
}

# What may be named where: (pattern, what it is, folders or files that may).
CONTAINED = [
    (r"\b_mm\w*\(|immintrin", "an intrinsic", {"simd", "parallel"}),  # parallel: the floating-point environment
    (r"\bhn::|hwy::HWY_NAMESPACE", "a vector register", {"simd"}),
    (r"\bstd::(thread|jthread|mutex|atomic|condition_variable|barrier)\b|\btbb::", "a thread", {"parallel"}),
    (r"\bgl[A-Z]\w*\(", "an OpenGL call", {"gl", "raster"}),
    (r"tiny_gltf|tinygltf::", "tinygltf", {"import"}),
    (r"tinyobj::", "tinyobjloader", {"import"}),
    (r"\bImGui|GLFW", "the window", set()),
    (r"\brtc[A-Z]\w*\(|embree", "the ray caster", {"ao/reference_rays.cpp"}),
]


# The same for the program: folders or files below viewer/ that may name it.
CONTAINED_IN_VIEWER = [
    (r"\bImGui\b|imgui|GLFW|glfw", "the window", ("window/",)),
    (r"GLFW|glfw[A-Z3]", "GLFW", ("window/glfw_window.cpp",)),
    (r"\bstd::(thread|jthread|mutex|atomic|condition_variable|barrier)\b", "a thread", ("window/render_worker.", "stop_signals.")),
    (r"\bgl[A-Z]\w*\(", "an OpenGL call", ()),
]


def viewer_breaches(root):
    for path in sorted((root / "viewer").rglob("*.*")):
        name = path.relative_to(root / "viewer").as_posix()
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            code = line.split("//")[0]
            for pattern, what, places in CONTAINED_IN_VIEWER:
                if re.search(pattern, code) and "window/glfw_window.h" not in code and not name.startswith(places):
                    yield f"viewer/{name}:{number}: names {what}, allowed only in {places or 'src/gl and src/raster'}"


def breaches(root):
    yield from viewer_breaches(root)
    for path in sorted((root / "src").rglob("*.*")):
        folder = path.relative_to(root / "src").parts[0]
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
            where = f"{path.relative_to(root)}:{number}"
            include = re.match(r'\s*#include "(\w+)/', line)
            if include and include.group(1) not in MAY_INCLUDE.get(folder, set()):
                yield f"{where}: {folder} may not include {include.group(1)}"
            code = line.split("//")[0]
            for pattern, what, folders in CONTAINED:
                if not {folder, str(path.relative_to(root / "src"))} & folders and re.search(pattern, code):
                    yield f"{where}: names {what}, allowed only in {sorted(folders) or 'viewer/window'}"


def main():
    found = list(breaches(pathlib.Path(sys.argv[1])))
    print("\n".join(found) or "layers hold")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
