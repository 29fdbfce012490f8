"""Scene files that another program changes while they are read."""

import os
import random as random_numbers
import shutil
import threading

import scenes
from program import BAD_INPUT, DONE, FAILED, fault_of


class Changer(threading.Thread):
    """Rewrites a file in place, cut off anywhere, with random bytes, or not at all, until stopped."""

    def __init__(self, path, seed, whole):
        super().__init__(daemon=True)
        self.path, self.content, self.whole = path, scenes.read(path), whole
        self.random = random_numbers.Random(seed)
        self.is_stopped = threading.Event()

    def run(self):
        while not self.is_stopped.is_set():
            content, kind = self.content, 0
            if self.whole:
                # Renaming gives readers either file, whole.
                scenes.write(self.path + ".next", self.random.choice(self.whole))
                os.replace(self.path + ".next", self.path)
            else:
                kind = self.random.randrange(5)
                if kind == 0:
                    content = content[:self.random.randrange(len(content) + 1)]
                elif kind == 1:
                    content = b""
                elif kind == 2:
                    at = self.random.randrange(len(content))
                    content = content[:at] + self.random.randbytes(min(64, len(content) - at)) + content[at + 64:]
                if kind == 3 and os.path.exists(self.path):
                    os.truncate(self.path, self.random.randrange(len(content)))
                else:
                    scenes.write(self.path, content)
            # Pauses after whole files let some reads end well.
            self.is_stopped.wait(self.random.expovariate(40.0 if kind == 4 else 1000.0))

    def stop(self):
        self.is_stopped.set()
        self.join()
        scenes.write(self.path, self.content)


def make_scenes(suite, folder):
    """The same room as .glb, .obj, .ply, and solutions of it. Larger files take longer to read."""
    shutil.copytree(suite.inputs, folder)
    fine = ["solve", "room.toml", "-o", "fine.vtp", "--max-patch-size", "0.15", "--rays", "64", "--gather-rays", "32"]
    for words in (fine, ["export", "fine.vtp", "-o", "m.glb", "-o", "m.obj", "-o", "m.ply"]):
        ended = suite.program.run(words, folder)
        if ended.code != DONE:
            raise SystemExit(f"error: '{' '.join(words)}' ended with exit code {ended.code}: {ended.last_words()}")


def run(suite):
    folder = os.path.join(suite.folder, "changing")
    make_scenes(suite, folder)
    torn = [("room.toml", ["solve", "room.toml", "-o", "out.vtp", *scenes.QUICK]), ("room.toml", ["info", "room.toml"]),
            ("m.glb", ["info", "m.glb"]), ("m.obj", ["info", "m.obj"]), ("m.mtl", ["info", "m.obj"]),
            ("m.ply", ["info", "m.ply"]), ("m.ply", ["mesh", "m.ply"]), ("fine.vtp", ["info", "fine.vtp"]),
            ("fine.vtp", ["export", "fine.vtp", "-o", "out.glb"]), ("p.exr", ["info", "p.exr"]),
            ("S.vtp", ["render", "room.toml", "S.vtp", "-o", "out.png"]),
            ("points.csv", ["probe", "room.toml", "S.vtp", "--points", "points.csv", "-o", "out.csv"])]
    for number, (name, words) in enumerate(torn):
        fault = f"changed while read, {os.path.splitext(name)[1]}"
        changer = Changer(os.path.join(folder, name), suite.random.random(), None)
        changer.start()
        for _ in range(suite.changes):
            ended = suite.program.run(words, folder)
            suite.findings.count(fault, "tried")
            # FAILED: the file was not there at that moment, or the solve found nothing to work on.
            broken = fault_of(ended, {DONE, FAILED, BAD_INPUT})
            if broken:
                suite.findings.add(fault, f"{words[0]} {name}: {broken}")
            suite.findings.count(fault, "new" if ended.code == DONE else "refused")
        changer.stop()
        suite.progress("changed while read", number + 1, len(torn))
    replaced_scene(suite, folder)


def replaced_scene(suite, folder):
    """A scene that is replaced while it is read is the old one or the new one: its hash is of one of the two."""
    fault = "replaced while read, .toml"
    rooms = [scenes.ROOM.encode(), scenes.OTHER_ROOM.encode()]
    path = os.path.join(folder, "room.toml")
    hashes = []
    for room in rooms:
        scenes.write(path, room)
        hashes.append(scene_hash(suite.program.run(["info", "room.toml", "--json"], folder)))
    changer = Changer(path, suite.random.random(), rooms)
    changer.start()
    for _ in range(suite.changes):
        ended = suite.program.run(["info", "room.toml", "--json"], folder)
        suite.findings.count(fault, "tried")
        if ended.code != DONE or scene_hash(ended) not in hashes:
            suite.findings.add(fault, f"exit code {ended.code}, or neither scene: {ended.last_words()}")
        else:
            suite.findings.count(fault, "old" if scene_hash(ended) == hashes[0] else "new")
    changer.stop()


def scene_hash(ended):
    marker = '"scene_hash": "'
    at = ended.out.find(marker) + len(marker)
    return ended.out[at:at + 16]
