"""Power cuts: a result is on the disk before it takes the old file's name, and before a checkpoint goes.

No power is cut. strace lists the system calls of a command; a file that is renamed without having been synced may be
empty after a power cut."""

import os
import re
import shutil
import subprocess

import scenes


def run(suite):
    fault = "power cut"
    if not shutil.which("strace"):
        suite.findings.skip(fault, "strace, which lists the system calls of a command, is not installed")
        return
    folder = os.path.join(suite.folder, "power")
    os.makedirs(os.path.join(folder, "results"))
    cases = [(writer.name, writer.words(suite.inputs, folder)) for writer in scenes.writers()]
    cases.append(("solve --checkpoint", ["solve", os.path.join(suite.inputs, "room.toml"), "-o",
                                         os.path.join(folder, "new.vtp"), *scenes.QUICK, "--checkpoint",
                                         os.path.join(folder, "C")]))
    log = os.path.join(suite.folder, "calls")
    for name, words in cases:
        traced = subprocess.run(["strace", "-f", "-y", "-o", log, "-e",
                                 "trace=fsync,fdatasync,rename,renameat,renameat2,unlink,unlinkat",
                                 suite.program.path, *words], cwd=folder, capture_output=True, text=True, check=False)
        if traced.returncode != 0:
            suite.findings.skip(fault, f"strace fails: {traced.stderr.strip().splitlines()[-1]}")
            return
        judge(suite, fault, name, scenes.read(log).decode(errors="replace"))


def judge(suite, fault, name, calls):
    synced, renamed = set(), []
    for line in calls.splitlines():
        sync = re.search(r"f(?:data)?sync\(\d+<([^>]*)>\) += 0", line)
        rename = re.search(r'rename\w*\((?:AT_FDCWD[^,]*, )?"([^"]*)", (?:AT_FDCWD[^,]*, )?"([^"]*)".*\) += 0', line)
        if sync:
            synced.add(sync[1])
        elif rename:
            suite.findings.count(fault, "tried")
            if os.path.realpath(rename[1]) not in synced and rename[1] not in synced:
                kind = os.path.splitext(rename[2])[1] or "checkpoint"
                suite.findings.add(fault, f"{name}: a {kind} file gets its name before its content is on the disk")
            else:
                suite.findings.count(fault, "new")
            renamed.append(os.path.dirname(rename[2]))
            synced.discard(renamed[-1])
        elif re.search(r'unlink\w*\(.*/C"', line) and any(place not in synced for place in renamed):
            suite.findings.add(fault, f"{name}: the checkpoint goes before the result's name is on the disk")
