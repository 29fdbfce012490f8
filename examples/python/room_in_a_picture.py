"""A room of a scene file in a picture, with its lamps dimmed afterwards.

    room_in_a_picture.py [SCENE [PICTURE.png]]
"""

import sys
from pathlib import Path

import numpy as np

import lightwell as lw

here = Path(__file__).resolve().parent
scene = lw.read(sys.argv[1] if len(sys.argv) > 1 else here.parent / "room" / "room.toml")
print(scene)

solution = lw.solve(scene, accuracy="5%", channels="per-luminaire", progress=None)
print(solution)
picture = solution.render(width=320, quality="draft")
if len(sys.argv) > 2:
    lw.write_picture(sys.argv[2], picture)

# Light is linear: with all lamps at half their power, every pixel has half the radiance.
dimmed = solution.relight({"*": 0.5}).render(width=320, quality="draft")
ratio = dimmed.mean() / picture.mean()
print(f"{picture.shape[1]} x {picture.shape[0]} pixels, mean radiance {picture.mean():.3g} W/(m^2 sr)")
print(f"dimmed to half: {ratio:.6f} of the light")
# A mean of some 10^5 float32 values, summed in pairs: 17 roundings.
sys.exit(int(np.isnan(ratio) or abs(ratio - 0.5) > 17 * 2.0**-24))
