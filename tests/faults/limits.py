"""Little memory, few descriptors: an end with a sentence, never by a signal."""

import os
import resource

import scenes
from full_disks import start
from program import BAD_INPUT, DONE, FAILED, SHORT, fault_of

MEMORY_CAUSES = ("memory", "Cannot allocate", "Resource temporarily unavailable", "thread")
FILE_CAUSES = ("Too many open files", "cannot be opened", "cannot be read")


def least_that_starts(suite, name, values):
    """The first value with which the program's libraries are loaded and --version ends well."""
    for value in values:
        if suite.program.run(["--version"], suite.inputs, [(name, value)]).code == DONE:
            return value
    raise SystemExit("error: the program does not start under any of the limits that were tried")


def try_all(suite, fault, name, values, causes):
    folder = os.path.join(suite.folder, "few")
    commands = [(writer.name, writer.words(suite.inputs, folder)) for writer in scenes.writers()]
    commands += [("info scene", ["info", "room.toml"]), ("info solution", ["info", "S.vtp"])]
    checkpoint, rows = os.path.join(folder, "C"), os.path.join(folder, "rows.vtp")
    commands.append(("solve --checkpoint", ["solve", "room.toml", *scenes.QUICK, "-o", rows, "--checkpoint", checkpoint]))
    commands.append(("solve, rows on disk", ["solve", "room.toml", *scenes.WORK, "-o", rows, "--memory", "60M"]))
    for number, (title, words) in enumerate(commands):
        for value in values:
            start(folder, {})
            ended = suite.program.run(words, suite.inputs, [(name, value)])
            suite.findings.count(fault, "tried")
            broken = fault_of(ended, {DONE, FAILED, BAD_INPUT, SHORT})
            if broken:
                suite.findings.add(fault, f"{title} with {value}: {broken}")
            elif ended.code in (DONE, SHORT):
                suite.findings.count(fault, "new")
            else:
                suite.findings.count(fault, "refused")
                if not any(cause in ended.err for cause in causes):
                    suite.findings.add(fault, f"{title} with {value}: the message names no cause: {ended.last_words()}")
                for at, _, files in os.walk(folder):
                    if any(name.endswith((".part", ".trial")) for name in files):
                        suite.findings.add(fault, f"{title} with {value}: a temporary file is left in {at}")
        suite.progress(fault, number + 1, len(commands))


def run(suite):
    megabyte = 1 << 20
    least = least_that_starts(suite, resource.RLIMIT_AS, [m * megabyte for m in range(40, 4000, 4)])
    steps = (0, 1, 2, 4, 6, 9, 13, 20, 30, 45, 70, 110, 170, 260, 400)
    try_all(suite, "limit of memory", resource.RLIMIT_AS, [least + m * megabyte for m in steps], MEMORY_CAUSES)
    least = least_that_starts(suite, resource.RLIMIT_NOFILE, range(1, 64))
    try_all(suite, "limit of descriptors", resource.RLIMIT_NOFILE, range(least, least + 8), FILE_CAUSES)
