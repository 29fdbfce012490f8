"""Kills at random moments: each output is the old file or the new one, and a resumed run has the same bits."""

import os
import re
import shutil
import signal
import time

import scenes
import whole_files
from program import DONE, INTERRUPTED, SHORT, fault_of

SIGNALS = (signal.SIGKILL, signal.SIGKILL, signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP)
# Signals end a command within a second on an idle machine; other programs may use this one.
LONGEST_END = 6.0
# Leftovers younger than ten minutes stay, since a process of another machine may be writing them.
OLD_ENOUGH = 1200


class Case:
    """A command with its results after a whole run (`new`) and from another scene (`old`)."""

    def __init__(self, name, words, old_words, outputs, resumes=False):
        self.name, self.words, self.old_words, self.outputs = name, words, old_words, outputs
        self.resumes = resumes
        self.ends_early = words[0] in ("solve", "run", "render")


def cases():
    work = scenes.WORK
    kept = ["--checkpoint", "C", "--resume", "--every", "0.1"]
    exports = [word for end in ("html", "glb", "ply", "obj") for word in ("-o", f"m.{end}")]
    reports = [word for end in ("html", "json", "csv") for word in ("-o", f"r.{end}")]
    asked = ["--plane", "room@0.75", "--observer", "door"]
    pictures = ["results/solution.vtp", "results/door.exr", "results/door.png", "results/report.json"]
    return [
        Case("solve", ["solve", "room.toml", "-o", "new.vtp", *work, *kept],
             ["solve", "other/room.toml", "-o", "new.vtp", *work], ["new.vtp"], True),
        Case("run", ["run", "room.toml", "-o", "results", *work, *kept],
             ["run", "other/room.toml", "-o", "results", *work], pictures, True),
        Case("render", ["render", "room.toml", "S.vtp", "-o", "p.exr", "-o", "p.png", "--pass", "gather", *kept],
             ["render", "other/room.toml", "other/S.vtp", "-o", "p.exr", "-o", "p.png"], ["p.exr", "p.png"], True),
        Case("export", ["export", "S.vtp", "--scene", "room.toml", *exports],
             ["export", "other/S.vtp", "--scene", "other/room.toml", *exports],
             ["m.html", "m.glb", "m.ply", "m.obj"]),
        Case("export --lightmap",
             ["export", "S.vtp", "--scene", "room.toml", "--lightmap", "--lightmap-size", "256", "-o", "m.glb"],
             ["export", "other/S.vtp", "--scene", "other/room.toml", "--lightmap", "--lightmap-size", "256", "-o",
              "m.glb"], ["m.glb", "m-lightmap-1.exr"]),
        Case("report", ["report", "room.toml", "S.vtp", *asked, *reports],
             ["report", "other/room.toml", "other/S.vtp", *asked, *reports], ["r.html", "r.json", "r.csv"]),
    ]


class Killing:
    """The killed runs of one case, in a folder of their own."""

    def __init__(self, suite, case):
        self.suite, self.case = suite, case
        self.fault = f"kill {case.name}"
        self.folder = os.path.join(suite.folder, "kill-" + re.sub(r"\W+", "-", case.name))
        shutil.copytree(suite.inputs, self.folder)
        self.old = self.whole_run(case.old_words)
        self.keep_old()
        self.new = self.whole_run(case.words)
        self.given = self.names() - set(case.outputs)
        self.cut_short = set()  # digests of what Ctrl-C left; they stay until the command is finished
        self.start_over()

    def path(self, name):
        return os.path.join(self.folder, name)

    def names(self):
        return {os.path.relpath(os.path.join(at, name), self.folder)
                for at, _, files in os.walk(self.folder) for name in files}

    def whole_run(self, words):
        ended = self.suite.program.run(words, self.folder)
        if ended.code != DONE:
            raise SystemExit(f"error: '{' '.join(words)}' ended with exit code {ended.code}: {ended.last_words()}")
        self.seconds = ended.seconds
        return self.digests()

    def digests(self):
        return {name: whole_files.digest(name, scenes.read(self.path(name))) for name in self.case.outputs}

    def keep_old(self):
        self.old_files = {name: scenes.read(self.path(name)) for name in self.case.outputs}

    def start_over(self):
        self.cut_short = set()
        for name, content in self.old_files.items():
            scenes.write(self.path(name), content)

    def found(self, sentence):
        self.suite.findings.add(self.fault, sentence)

    def check_outputs(self, moment, cut_short):
        """Counts old and new files; anything else is a finding, except what Ctrl-C cut short."""
        for name in self.case.outputs:
            try:
                content = scenes.read(self.path(name))
                value = whole_files.digest(name, content)
                if value == self.old[name]:
                    self.suite.findings.count(self.fault, "old")
                    continue
                self.suite.findings.count(self.fault, "new")
                if cut_short:
                    self.cut_short.add(value)
                elif value != self.new[name] and value not in self.cut_short:
                    self.found(f"'{name}' is neither old nor new after {moment}")
                if name.endswith(".png"):
                    whole_files.check_png(content)
            except Exception as error:  # whatever reading a torn file throws
                self.found(f"'{name}' is torn after {moment}: {error!r}")
                continue
            if name.endswith((".vtp", ".exr")):
                ended = self.suite.program.run(["info", name], self.folder)
                if ended.code != DONE:
                    self.found(f"'info {name}' ends with exit code {ended.code} after {moment}: {ended.last_words()}")

    def check_leftovers(self, moment):
        """Makes leftovers old enough to be removed by the next run."""
        for name in self.names() - self.given - set(self.case.outputs) - {"C"}:
            match = whole_files.LEFTOVER.match(name)
            if not match or match[1] not in {*self.case.outputs, *self.extra_outputs()}:
                self.found(f"the file '{re.sub('[0-9]+', 'N', name)}' is left after {moment}")
                os.remove(self.path(name))
                continue
            self.suite.findings.leftovers += 1
            then = time.time() - OLD_ENOUGH
            os.utime(self.path(name), (then, then))

    def extra_outputs(self):
        return {"C"} | {os.path.splitext(name)[0] + ".mtl" for name in self.case.outputs if name.endswith(".obj")}

    def writes(self):
        """True while the folders of the results hold a temporary file."""
        folders = {os.path.dirname(self.path(name)) for name in self.case.outputs}
        return any(name.endswith((".part", ".trial")) for folder in folders for name in os.listdir(folder))

    def kill_once(self, random):
        number = random.choice(SIGNALS)
        delay = random.uniform(0.0, 1.1) * self.seconds
        name = signal.Signals(number).name
        moment = f"{name} at {delay:.3f} s"
        until = None
        if random.random() < 0.4:
            # Files are written in milliseconds, which random moments rarely meet.
            until, delay = self.writes, random.choice((0.0, random.expovariate(1000.0)))
            moment = f"{name} during writing"
        ended = self.suite.program.run(self.case.words, self.folder, signal_number=number, delay=delay, until=until)
        self.suite.findings.count(self.fault, "tried")
        cut_short = number == signal.SIGINT and self.case.ends_early
        allowed = {DONE, INTERRUPTED} | ({SHORT} if cut_short else set())
        # A signal that comes while the program's libraries are loaded ends a process that did nothing yet.
        not_begun = ended.code == -number and ended.err == ""
        if number != signal.SIGKILL and not not_begun:
            fault = fault_of(ended, allowed)
            if fault:
                self.found(f"{fault} after {moment}")
            if ended.seconds > LONGEST_END and not cut_short:
                self.found(f"{name} took {ended.seconds:.1f} s to end the command")
            if ended.code == INTERRUPTED and self.case.resumes and os.path.exists(self.path("C")) and \
                    "To resume:" not in ended.err and "half-written" not in ended.err:
                self.found(f"{moment} left a checkpoint without a message: {ended.last_words()}")
        self.check_outputs(moment, cut_short)
        self.check_leftovers(moment)
        if self.case.resumes and random.random() < 0.6:
            return  # the next kill hits the resumed run
        self.finish(moment)

    def finish(self, moment):
        ended = self.suite.program.run(self.case.words, self.folder)
        if ended.code != DONE:
            self.found(f"the run after {moment} ends with exit code {ended.code}: {ended.last_words()}")
            if os.path.exists(self.path("C")):
                os.remove(self.path("C"))
        else:
            after = self.digests()
            for name in self.case.outputs:
                if after[name] != self.new[name]:
                    self.found(f"'{name}' of the run after {moment} differs from an undisturbed run's")
            for name in self.names() - self.given - set(self.case.outputs):
                self.found(f"'{re.sub('[0-9]+', 'N', name)}' is still there after the next run ({moment})")
                os.remove(self.path(name))
        self.start_over()


def run(suite):
    killings = [Killing(suite, case) for case in cases()]
    suite.findings.leftovers = 0
    weights = [4, 3, 1, 2, 1, 2]
    for number in range(suite.kills):
        suite.random.choices(killings, weights)[0].kill_once(suite.random)
        suite.progress("kill", number + 1, suite.kills)
    for killing in killings:
        killing.finish("the last kill")
    print(f"  {suite.findings.leftovers} .part files were left, and removed by the next run")
