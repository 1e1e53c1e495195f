#!/usr/bin/env python3
"""Files that `tenebra bake` wrote, opened by three.js in headless Chromium: the picture that three.js draws of a baked
room, with its lightmap or the colours of its vertices, is the one that `tenebra render` draws of the room and its lamp.

usage: three_test.py PROGRAM SCENE THREE BROWSER        (THREE: the folder of npm's package; exit code 1 on a difference)
"""
import base64
import functools
import http.server
import pathlib
import re
import subprocess
import sys
import tempfile
import threading

SIZE = (320, 240)
EXPOSURE = 0.25  # leaves nothing brighter than white
PAGE = """<!DOCTYPE html><title>three</title><pre id="says"></pre>
<script type="importmap">{"imports": {"three": "./three/build/three.module.js", "three/addons/": "./three/examples/jsm/"}}</script>
<script type="module">
import * as THREE from 'three';
import { GLTFLoader } from 'three/addons/loaders/GLTFLoader.js';
import { EXRLoader } from 'three/addons/loaders/EXRLoader.js';
const says = text => document.getElementById('says').append(text + '\\n');
console.warn = (...words) => says('warning: ' + words.join(' '));
console.error = (...words) => says('error: ' + words.join(' '));
try {
  const gltf = await new GLTFLoader().loadAsync('KIND.glb');
  const file = new URLSearchParams(location.search).get('map');
  let map = null;
  if (file) {
    map = await (file.endsWith('.exr') ? new EXRLoader() : new THREE.TextureLoader()).loadAsync(file);
    map.channel = 1;
    if (file.endsWith('.exr')) { if (!map.flipY) { map.repeat.y = -1; map.offset.y = 1; map.wrapT = THREE.RepeatWrapping; } }
    else { map.flipY = false; map.colorSpace = THREE.SRGBColorSpace; }
  }
  gltf.scene.traverse(o => {
    if (o.isLight) o.visible = false;
    if (!o.isMesh) return;
    says('mesh: ' + Object.keys(o.geometry.attributes).sort().join(' ') + ' ' + o.material.type);
    if (map) {
      o.material = new THREE.MeshBasicMaterial({color: o.material.color, lightMap: map,
        lightMapIntensity: Math.PI / (file.endsWith('.exr') ? 1 : EXPOSURE)});
    } else o.material.color.multiplyScalar(1 / EXPOSURE);
  });
  const renderer = new THREE.WebGLRenderer({preserveDrawingBuffer: true});
  renderer.setSize(WIDTH, HEIGHT);
  const camera = gltf.cameras[0];
  camera.aspect = WIDTH / HEIGHT;
  camera.updateProjectionMatrix();
  gltf.scene.updateMatrixWorld(true);
  renderer.render(gltf.scene, camera);
  says('picture: ' + renderer.domElement.toDataURL('image/png'));
} catch (error) { says('error: ' + error); }
says('done');
</script>
"""


class Quiet(http.server.SimpleHTTPRequestHandler):
    extensions_map = {**http.server.SimpleHTTPRequestHandler.extensions_map, ".js": "text/javascript"}

    def log_message(self, *_):
        pass


def run(program, *words):
    return subprocess.run([program, *map(str, words)], check=True, capture_output=True, text=True).stdout


def bake(program, scene, folder):
    common = ("--shadows", "soft", "--what", "both", "--quiet")
    run(program, "bake", scene, *common, "--exposure", EXPOSURE, "-o", folder / "vertices.glb")
    run(program, "bake", scene, *common, "--exposure", EXPOSURE, "--to", "lightmap", "--size", 1024, "--map",
        folder / "map.png", "-o", folder / "lightmap.glb")
    run(program, "bake", scene, *common, "--to", "lightmap", "--size", 1024, "--map", folder / "map.exr", "-o",
        folder / "lightmap.glb")
    run(program, "render", scene, "--frames", 0, "--size", "%dx%d" % SIZE, "--shadows", "soft", "--antialias", 1,
        "--tone", "none", "--ao", "adaptive", "--quiet", "-o", folder / "expected.png")


def shown(browser, address):
    """What the page says, once it is done."""
    page = subprocess.run([browser, "--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader",
                           "--enable-unsafe-swiftshader", "--virtual-time-budget=60000", "--dump-dom", address],
                          check=True, capture_output=True, text=True, timeout=300).stdout
    said = re.search(r'<pre id="says">(.*?)</pre>', page, re.S)
    lines = said.group(1).strip().split("\n") if said else []
    if not lines or lines[-1] != "done":
        sys.exit("three_test.py: %s: the page did not end: %s" % (address, page[:400]))
    return lines


def main(program, scene, three, browser):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        bake(program, scene, folder)
        (folder / "three").symlink_to(pathlib.Path(three).resolve())
        for kind in ("vertices", "lightmap"):
            page = PAGE.replace("KIND", kind).replace("WIDTH", str(SIZE[0])).replace("HEIGHT", str(SIZE[1]))
            (folder / (kind + ".html")).write_text(page.replace("EXPOSURE", str(EXPOSURE)), encoding="utf-8")
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(Quiet, directory=name))
        threading.Thread(target=server.serve_forever, daemon=True).start()
        failed = False
        for query, wanted, most in (("lightmap.html?map=map.png", "uv1", 4), ("lightmap.html?map=map.exr", "uv1", 4),
                                    ("vertices.html", "color", 60)):
            lines = shown(browser, "http://127.0.0.1:%d/%s" % (server.server_port, query))
            for line in lines:
                if line.startswith(("error", "warning")) and "'m44f'" not in line:  # a matrix in the header is no fault
                    print("%s: three.js says %s" % (query, line), file=sys.stderr)
                    failed = True
            meshes = [line for line in lines if line.startswith("mesh:")]
            pictures = [line for line in lines if line.startswith("picture:")]
            if not meshes or not all(wanted in mesh.split() for mesh in meshes) or not pictures:
                print("%s: found %s, expected meshes with %s" % (query, meshes, wanted), file=sys.stderr)
                failed = True
                continue
            picture = folder / (query.replace("?", "_").replace("/", "_") + ".png")
            picture.write_bytes(base64.b64decode(pictures[0].split(",", 1)[1]))
            said = subprocess.run([program, "compare", folder / "expected.png", picture], capture_output=True, text=True,
                                  check=False).stdout
            rms = float(re.search(r"RMS ([0-9.]+)", said).group(1))
            print("%s: %d meshes, RMS %.2f levels from the rendered picture" % (query, len(meshes), rms))
            failed |= rms > most
        server.shutdown()
        return 1 if failed else 0


if __name__ == "__main__":
    if len(sys.argv) != 5:
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:]))
