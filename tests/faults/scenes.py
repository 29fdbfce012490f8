"""A small room, and every command that writes files, with options that take a moment."""

import os

DATA = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "data")
with open(os.path.join(DATA, "small_room.toml"), encoding="utf-8") as small_room:
    ROOM = small_room.read()
# The same room with another reflectance, for old files that differ from new ones.
OTHER_ROOM = ROOM.replace("0.7, 0.5, 0.3", "0.6, 0.5, 0.4")
POINTS = "x,y,z,nx,ny,nz\n" + "".join(f"{x / 5},1.5,0.7,0,0,1\n" for x in range(1, 20))
CHANNELS = ["--channels", "per-luminaire"]
QUICK = ["--max-patch-size", "1", "--rays", "64", "--gather-rays", "32"]
# A solve of about a second.
WORK = ["--max-patch-size", "0.4", "--rays", "1024", "--gather-rays", "128"]


class Writer:
    """A command that writes `outputs`. Files of the folder `{i}` are read, files go to `{o}`."""

    def __init__(self, name, words, outputs):
        self.name, self.outputs = name, outputs
        self.words_ = words.split() if isinstance(words, str) else words

    def words(self, inputs, results, scene="room.toml"):
        places = {"i": inputs, "o": results, "s": os.path.join(inputs, scene)}
        return [word.format(**places) for word in self.words_]


def writers():
    quick = " ".join(QUICK)
    export, report = "export {i}/S.vtp --scene {s} ", "report {s} {i}/S.vtp --plane room@0.75 --observer door "
    return [
        Writer("solve .vtp", f"solve {{s}} -o {{o}}/new.vtp {quick}", ["new.vtp"]),
        Writer("run", f"run {{s}} -o {{o}}/results {quick}",
               ["results/solution.vtp", "results/door.exr", "results/door.png", "results/report.json"]),
        Writer("mesh .vtp", "mesh {s} -o {o}/mesh.vtp", ["mesh.vtp"]),
        Writer("relight .vtp", "relight {i}/S.vtp --channel panel=0.5 -o {o}/dim.vtp", ["dim.vtp"]),
        Writer("render .png", "render {s} {i}/S.vtp -o {o}/p.png", ["p.png"]),
        Writer("render .exr", "render {s} {i}/S.vtp --layers all -o {o}/p.exr", ["p.exr"]),
        Writer("render .exr, uncompressed", "render {s} {i}/S.vtp --compression none -o {o}/p.exr", ["p.exr"]),
        Writer("export .html", export + "-o {o}/m.html", ["m.html"]),
        Writer("export .glb", export + "-o {o}/m.glb", ["m.glb"]),
        Writer("export .glb, lightmap", export + "--lightmap --lightmap-size 128 -o {o}/m.glb",
               ["m.glb", "m-lightmap-1.exr"]),
        Writer("export .ply", export + "-o {o}/m.ply", ["m.ply"]),
        Writer("export .obj", export + "-o {o}/m.obj", ["m.obj", "m.mtl"]),
        Writer("report .html", report + "-o {o}/r.html", ["r.html"]),
        Writer("report .json", report + "-o {o}/r.json", ["r.json"]),
        Writer("report .csv", report + "-o {o}/r.csv", ["r.csv"]),
        Writer("probe .csv", "probe {s} {i}/S.vtp --points {i}/points.csv -o {o}/lux.csv", ["lux.csv"]),
        Writer("form-factors .mtx", "form-factors {s} --max-patch-size 1 -o {o}/F.mtx", ["F.mtx", "F.json"]),
        Writer("form-factors --view3d", "form-factors {s} --max-patch-size 1 -o {o}/F.mtx --view3d {o}/F.txt",
               ["F.mtx", "F.json", "F.txt"]),
        Writer("form-factors --show-row", "form-factors {s} --max-patch-size 1 -o {o}/F.mtx --show-row 1",
               ["F.mtx", "F.json", "F.row1.vtp"]),
        Writer("compare .png", "compare {i}/p.exr {i}/q.exr -o {o}/d.png", ["d.png"]),
    ]


def write(path, text):
    with open(path, "wb" if isinstance(text, bytes) else "w") as file:
        file.write(text)


def read(path):
    with open(path, "rb") as file:
        return file.read()


def make_inputs(program, folder):
    """Scenes, points, solutions and pictures that commands read. `other` holds the files of another
    room under the same names, for old results."""
    for place, room in ((folder, ROOM), (os.path.join(folder, "other"), OTHER_ROOM)):
        os.makedirs(place, exist_ok=True)
        write(os.path.join(place, "room.toml"), room)
        write(os.path.join(place, "points.csv"), POINTS)
        for words in (["solve", "room.toml", "-o", "S.vtp", *QUICK, *CHANNELS],
                      ["render", "room.toml", "S.vtp", "-o", "p.exr"],
                      ["render", "room.toml", "S.vtp", "-o", "q.exr", "--pass", "interpolate"]):
            if place != folder and words[1:2] == ["room.toml"] and "q.exr" in words:
                words = [*words, "--size", "48x32", "--depth", "0"]
            ended = program.run(words, place)
            if ended.code != 0:
                raise SystemExit(f"error: the suite cannot begin, since '{' '.join(words)}' ended with exit code "
                                 f"{ended.code}: {ended.last_words()}")
