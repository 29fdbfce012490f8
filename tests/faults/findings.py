"""Counts of faults that were tried, and of promises that were broken."""

import collections

COLUMNS = ("tried", "old", "new", "refused", "findings")


class Findings:
    def __init__(self):
        self.counts = collections.OrderedDict()
        self.sentences = []
        self.skipped = []

    def count(self, fault, column, number=1):
        self.counts.setdefault(fault, collections.Counter())[column] += number

    def add(self, fault, sentence):
        self.count(fault, "findings")
        self.sentences.append(f"{fault}: {sentence}")
        print(f"  FINDING {fault}: {sentence}", flush=True)

    def skip(self, fault, reason):
        self.skipped.append(f"{fault}: skipped, since {reason}")

    def print_table(self):
        print(f"\n{'fault':44}" + "".join(f"{name:>10}" for name in COLUMNS))
        total = collections.Counter()
        for fault, counts in self.counts.items():
            total.update(counts)
            print(f"{fault:44}" + "".join(f"{counts[name]:10}" for name in COLUMNS))
        print(f"{'all':44}" + "".join(f"{total[name]:10}" for name in COLUMNS))
        for sentence in self.skipped:
            print(sentence)
        shown = list(dict.fromkeys(self.sentences))
        if shown:
            print("\nFindings:")
        for sentence in shown:
            print("  " + sentence)
