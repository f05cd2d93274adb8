"""aitviewer drawing one moving mesh offscreen: floor, two lights with shadow maps, edges smoothed by 4 samples.

    python aitviewer_frames.py SCENE.npz OUT.png      (run by bench/render.py --rivals, in an environment of its own)
"""

import json
import sys
import time

import moderngl
import numpy as np
from aitviewer.configuration import CONFIG

made = moderngl.create_standalone_context
moderngl.create_standalone_context = lambda **options: made(**{**options, "backend": "egl"})
scene = np.load(sys.argv[1])
width, height = scene["size"].tolist()
CONFIG.update_conf({"window_width": width, "window_height": height, "device": "cpu"})

from aitviewer.headless import HeadlessRenderer
from aitviewer.renderables.meshes import Meshes

viewer = HeadlessRenderer()
viewer.scene.add(Meshes(scene["vertices"], scene["triangles"].astype(int), color=(0.75, 0.42, 0.22, 1.0)))
viewer.scene.origin.enabled = False
viewer.scene.camera.position, viewer.scene.camera.target = scene["eye"], scene["target"]
viewer.scene.camera.fov = float(np.degrees(scene["fov"]))
viewer.auto_set_camera_target = False
took = []
for k in range(int(scene["frames"]) + 5):
    if k == 5:
        spent = time.process_time()
    began = time.perf_counter()
    viewer.scene.next_frame()
    picture = np.asarray(viewer.get_frame())
    took.append(1000.0 * (time.perf_counter() - began))
spent = 1000.0 * (time.process_time() - spent) / int(scene["frames"])
viewer.get_frame().save(sys.argv[2])
assert picture.shape[:2] == (height, width), picture.shape
print(json.dumps({"draws": viewer.ctx.info["GL_RENDERER"], "took": took[5:], "processor": spent}))
