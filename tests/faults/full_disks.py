"""Disks that are full, limits of file sizes, and a full standard output: the reason is named, and the old file stays."""

import ctypes
import os
import resource
import shutil
import subprocess

import scenes
import whole_files
from program import DONE, FAILED, fault_of

SHARES = (0.0, 0.02, 0.3, 0.6, 0.9, 0.999)
DISK = 8 << 20


def reference(suite, writer):
    """Old and new files of a writer, from two scenes."""
    results = {}
    for age, inputs in (("old", os.path.join(suite.inputs, "other")), ("new", suite.inputs)):
        folder = os.path.join(suite.folder, "reference")
        shutil.rmtree(folder, ignore_errors=True)
        os.makedirs(os.path.join(folder, "results"))
        ended = suite.program.run(writer.words(inputs, folder), folder)
        if ended.code != DONE:
            raise SystemExit(f"error: {writer.name} ended with exit code {ended.code}: {ended.last_words()}")
        results[age] = {name: scenes.read(os.path.join(folder, name)) for name in writer.outputs}
    return results["old"], results["new"]


def start(folder, old):
    shutil.rmtree(os.path.join(folder, "results"), ignore_errors=True)
    os.makedirs(os.path.join(folder, "results"))
    for name in os.listdir(folder):
        if name != "results":
            os.remove(os.path.join(folder, name))
    for name, content in old.items():
        scenes.write(os.path.join(folder, name), content)


def judge(suite, fault, writer, folder, old, new, ended, causes, detail):
    findings = suite.findings
    findings.count(fault, "tried")
    broken = fault_of(ended, {DONE, FAILED})
    if broken:
        findings.add(fault, f"{writer.name}, {detail}: {broken}")
    if ended.code == FAILED:
        findings.count(fault, "refused")
        if not any(cause in ended.err for cause in causes):
            findings.add(fault, f"{writer.name}, {detail}: the message names no cause: {ended.last_words()}")
    replaced = 0
    for name in writer.outputs:
        path = os.path.join(folder, name)
        content = scenes.read(path) if os.path.exists(path) else None
        if content == old[name]:
            findings.count(fault, "old")
            if ended.code == DONE and old[name] != new[name]:
                findings.add(fault, f"{writer.name}, {detail}: '{name}' is old although the command is done")
            continue
        try:
            is_new = whole_files.digest(name, content) == whole_files.digest(name, new[name])
        except Exception:
            is_new = False
        if is_new:
            replaced += 1
            findings.count(fault, "new")
        else:
            findings.add(fault, f"{writer.name}, {detail}: '{name}' is neither old nor new")
    known = {os.path.basename(name) for name in writer.outputs} | {"filler"}
    for at, _, files in os.walk(folder):
        for name in set(files) - known:
            findings.add(fault, f"{writer.name}, {detail}: '{name}' is left")
            os.remove(os.path.join(at, name))


def limited_files(suite, cases):
    folder = os.path.join(suite.folder, "limited")
    for writer, old, new in cases:
        largest = max(len(content) for content in new.values())
        for share in SHARES:
            start(folder, old)
            limit = int(share * largest)
            ended = suite.program.run(writer.words(suite.inputs, folder), folder,
                                      [(resource.RLIMIT_FSIZE, limit)])
            judge(suite, "limit of file sizes", writer, folder, old, new, ended, ("File too large",),
                  f"limit {limit} of {largest} bytes")
        suite.progress("limit of file sizes", cases.index((writer, old, new)) + 1, len(cases))


def own_mounts():
    """Gives this process mounts of its own. The reason if that is not possible."""
    libc = ctypes.CDLL(None, use_errno=True)
    new_mounts, new_user = 0x00020000, 0x10000000
    user, group = os.getuid(), os.getgid()
    if libc.unshare(new_mounts) != 0:
        if libc.unshare(new_mounts | new_user) != 0:
            return "mounting a small disk needs root or user namespaces: " + os.strerror(ctypes.get_errno())
        scenes.write("/proc/self/setgroups", "deny")
        scenes.write("/proc/self/uid_map", f"0 {user} 1")
        scenes.write("/proc/self/gid_map", f"0 {group} 1")
    made = subprocess.run(["mount", "--make-rprivate", "/"], capture_output=True, text=True)
    return made.stderr.strip()


def full_disk(suite, cases):
    fault = "full disk"
    folder = os.path.join(suite.folder, "disk")
    os.makedirs(folder)
    reason = own_mounts()
    if not reason:
        reason = subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={DISK}", "tmpfs", folder],
                                capture_output=True, text=True).stderr.strip()
    if reason:
        suite.findings.skip(fault, reason)
        return
    for number, (writer, old, new) in enumerate(cases):
        total = sum(len(content) for content in new.values())
        for share in SHARES:
            start(folder, old)
            free = int(share * total)
            fill(folder, free)
            ended = suite.program.run(writer.words(suite.inputs, folder), suite.folder)
            os.remove(os.path.join(folder, "filler"))
            judge(suite, fault, writer, folder, old, new, ended, ("No space left on device",),
                  f"{free} of {total} bytes are free")
        suite.progress(fault, number + 1, len(cases))
    full_checkpoint(suite, folder)
    subprocess.run(["umount", folder], check=False)


def fill(folder, free):
    """Leaves about `free` bytes of the disk."""
    state = os.statvfs(folder)
    with open(os.path.join(folder, "filler"), "wb") as file:
        os.posix_fallocate(file.fileno(), 0, max(1, state.f_bavail * state.f_bsize - free))


def full_checkpoint(suite, folder):
    """A checkpoint that cannot be written any more is a warning; one that cannot be created is an error."""
    fault = "full disk, checkpoint"
    solve = ["solve", "room.toml", "-o", "new.vtp", *scenes.WORK]
    whole = suite.program.run(solve, suite.inputs)
    path = os.path.join(suite.inputs, "new.vtp")
    wanted = whole_files.digest(path, scenes.read(path))
    kept = ["--checkpoint", os.path.join(folder, "C"), "--every", "0.1", "--keep-checkpoint"]
    for free in (0, 4096, 40960, 409600):
        start(folder, {})
        os.remove(path)
        fill(folder, free)
        ended = suite.program.run([*solve, *kept], suite.inputs)
        suite.findings.count(fault, "tried")
        broken = fault_of(ended, {DONE, FAILED})
        if broken:
            suite.findings.add(fault, f"{free} bytes are free: {broken}")
        if ended.code == FAILED or "cannot be written any more" in ended.err:
            suite.findings.count(fault, "refused")
            if "No space left on device" not in ended.err:
                suite.findings.add(fault, f"the message names no cause: {ended.last_words()}")
        os.remove(os.path.join(folder, "filler"))
        resumed = suite.program.run([*solve, *kept, "--resume"], suite.inputs)
        if resumed.code != DONE:
            suite.findings.add(fault, f"the resumed solve ends with exit code {resumed.code}: {resumed.last_words()}")
        elif whole_files.digest(path, scenes.read(path)) != wanted:
            suite.findings.add(fault, "the resumed solve has other bits")
        else:
            suite.findings.count(fault, "new")
    assert whole.code == DONE


def full_standard_output(suite):
    fault = "full standard output"
    commands = [writer.words(suite.inputs, suite.folder) for writer in scenes.writers()
                if not writer.name.startswith("run")]
    commands += [["info", "room.toml"], ["info", "S.vtp"], ["info", "p.exr"], ["compare", "p.exr", "q.exr"],
                 ["--version"], ["--help"], ["solve", "--help"], []]
    for words in commands:
        for more in ([], ["--json"]):
            if more and not words:
                continue
            with open("/dev/full", "wb") as full:
                ended = suite.program.run([*words, *more], suite.inputs, out=full)
            suite.findings.count(fault, "tried")
            broken = fault_of(ended, {FAILED})
            if broken:
                suite.findings.add(fault, f"lightwell {' '.join(words[:1] + more)}: {broken}")
            else:
                suite.findings.count(fault, "refused")


def full_standard_error(suite):
    """A log that cannot be written changes no exit code and no result."""
    fault = "full standard error"
    bad = [["solve", "nothing.toml", "-o", "new.vtp"], ["render", "room.toml"], ["info", "points.csv"]]
    for words in [writer.words(suite.inputs, suite.folder) for writer in scenes.writers()] + bad:
        normal = suite.program.run(words, suite.folder)
        with open("/dev/full", "wb") as full:
            ended = suite.program.run(words, suite.folder, err=full)
        suite.findings.count(fault, "tried")
        if ended.code != normal.code:
            suite.findings.add(fault, f"lightwell {words[0]}: exit code {ended.code} in place of {normal.code}")
        else:
            suite.findings.count(fault, "new" if ended.code == DONE else "refused")


def run(suite):
    cases = [(writer, *reference(suite, writer)) for writer in scenes.writers()]
    limited_files(suite, cases)
    full_standard_output(suite)
    full_standard_error(suite)
    full_disk(suite, cases)
