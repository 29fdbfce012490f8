"""Solutions, checkpoints and pictures that are cut off or have a wrong bit: refused, or the same result."""

import os
import shutil

import scenes
import whole_files
from program import BAD_INPUT, DONE, fault_of


def damaged(content, random):
    """`content` cut off, with one to three turned bits, or with bytes from elsewhere; and what was done."""
    kind = random.randrange(10)
    if kind < 3:
        at = random.randrange(len(content))
        return content[:at], f"cut off at byte {at} of {len(content)}"
    if kind < 9:
        changed = bytearray(content)
        # Heads decide how the rest is read, so they get half of the flips.
        within = len(content) if random.random() < 0.5 else min(len(content), 8192)
        places = [random.randrange(within) for _ in range(random.choice((1, 1, 1, 3)))]
        for at in places:
            changed[at] ^= 1 << random.randrange(8)
        return bytes(changed), f"bits turned at bytes {places} of {len(content)}"
    at, source, size = (random.randrange(len(content)) for _ in range(3))
    size %= 4096
    return content[:at] + content[source:source + size] + content[at + size:], f"bytes replaced from {at}"


def damaged_solutions(suite, folder):
    commands = [["render", "room.toml", "D.vtp", "-o", "out.png"],
                ["probe", "room.toml", "D.vtp", "--points", "points.csv", "-o", "out.csv"],
                ["export", "D.vtp", "--scene", "room.toml", "-o", "out.glb"],
                ["relight", "D.vtp", "--channel", "panel=0.5", "-o", "out.vtp"],
                ["report", "room.toml", "D.vtp", "--plane", "room@0.75", "-o", "out.json"],
                ["solve", "room.toml", "--start-from", "D.vtp", "-o", "out.vtp", *scenes.QUICK],
                ["solve", "room.toml", "-o", "D.vtp", *scenes.QUICK, *scenes.CHANNELS, "--checkpoint", "K", "--resume"]]
    whole = scenes.read(os.path.join(folder, "S.vtp"))
    path = os.path.join(folder, "D.vtp")
    right = {}
    for number in range(suite.flips + 1):
        content, what = damaged(whole, suite.random) if number > 0 else (whole, "nothing changed")
        chosen = commands if number == 0 else [commands[number % len(commands)]]
        for words in [["info", "D.vtp"], *chosen]:
            scenes.write(path, content)
            output = os.path.join(folder, words[words.index("-o") + 1]) if "-o" in words else ""
            if output and output != path and os.path.exists(output):
                os.remove(output)
            ended = suite.program.run(words, folder)
            title = " ".join(words[:1] + [word for word in words if word in ("--start-from", "--resume")])
            fault = f"damaged solution, {title}"
            suite.findings.count(fault, "tried")
            broken = fault_of(ended, {DONE, BAD_INPUT})
            if broken:
                suite.findings.add(fault, f"{what}: {broken}")
            if ended.code != DONE:
                suite.findings.count(fault, "refused")
                continue
            result = whole_files.digest(output, scenes.read(output)) if output else ended.out
            if result != right.setdefault(title, result):
                suite.findings.add(fault, f"{what}: another result, without an error")
            suite.findings.count(fault, "new")
        suite.progress("damaged solution", number, suite.flips)


def damaged_checkpoints(suite, folder):
    solve = ["solve", "room.toml", "-o", "out.vtp", *scenes.QUICK]
    kept = [*solve, "--checkpoint", "C", "--resume"]
    output, path = os.path.join(folder, "out.vtp"), os.path.join(folder, "C")
    ended = suite.program.run([*kept, "--keep-checkpoint"], folder)
    if ended.code != DONE:
        raise SystemExit(f"error: a solve with a checkpoint ended with exit code {ended.code}: {ended.last_words()}")
    wanted = whole_files.digest(output, scenes.read(output))
    whole = scenes.read(path)
    for number in range(suite.flips):
        content, what = damaged(whole, suite.random)
        for words, fault in ((kept, "damaged checkpoint, --resume"),
                             ([*solve, "--reuse", "C"], "damaged checkpoint, --reuse")):
            scenes.write(path, content)
            if os.path.exists(output):
                os.remove(output)
            ended = suite.program.run(words, folder)
            suite.findings.count(fault, "tried")
            broken = fault_of(ended, {DONE, BAD_INPUT})
            if broken:
                suite.findings.add(fault, f"{what}: {broken}")
            if ended.code == DONE:
                suite.findings.count(fault, "new")
                if whole_files.digest(output, scenes.read(output)) != wanted:
                    suite.findings.add(fault, f"{what}: another result, without an error")
            else:
                suite.findings.count(fault, "refused")
                if "--resume" in words and scenes.read(path) != content:
                    suite.findings.add(fault, f"{what}: the refused checkpoint was changed")
        suite.progress("damaged checkpoint", number + 1, suite.flips)
    os.remove(path)


def damaged_pictures(suite, folder):
    """EXR has no checksums, so a wrong bit may be a wrong pixel; the end must be clean all the same."""
    fault = "damaged picture"
    whole = scenes.read(os.path.join(folder, "p.exr"))
    for number in range(suite.flips // 2):
        content, what = damaged(whole, suite.random)
        scenes.write(os.path.join(folder, "D.exr"), content)
        for words in (["info", "D.exr"], ["compare", "D.exr", "q.exr"]):
            ended = suite.program.run(words, folder)
            suite.findings.count(fault, "tried")
            broken = fault_of(ended, {DONE, BAD_INPUT})
            if broken:
                suite.findings.add(fault, f"{words[0]}, {what}: {broken}")
            suite.findings.count(fault, "new" if ended.code == DONE else "refused")
        suite.progress(fault, number + 1, suite.flips // 2)


def run(suite):
    folder = os.path.join(suite.folder, "damage")
    shutil.copytree(suite.inputs, folder)
    damaged_solutions(suite, folder)
    damaged_checkpoints(suite, folder)
    damaged_pictures(suite, folder)
