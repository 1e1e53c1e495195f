#!/usr/bin/env python3
"""Every part of tools/nightly.sh runs on one day of the week in .github/workflows/nightly.yml.

usage: nightly_test.py ROOT        (prints a sentence for each part that does not; exit code 1 if there is one)
"""
import pathlib
import re
import sys


def main():
    root = pathlib.Path(sys.argv[1])
    parts = re.search(r"^parts=\((.*)\)$", (root / "tools/nightly.sh").read_text(encoding="utf-8"), re.M)[1].split()
    workflow = (root / ".github/workflows/nightly.yml").read_text(encoding="utf-8")
    days = re.findall(r'^ +(\d)\) parts="(.*)"', workflow, re.M)
    scheduled = [part for _, of_day in days for part in of_day.split()]
    found = [f"nightly.yml runs {part} {scheduled.count(part)} times a week, expected once" for part in parts
             if scheduled.count(part) != 1]
    found += [f"nightly.yml: found the part {part}, which tools/nightly.sh does not know" for part in scheduled
              if part not in parts]
    if sorted(day for day, _ in days) != list("1234567"):
        found.append("nightly.yml: expected a line for each day of the week, 1 to 7")
    print("\n".join(found) or "every part has its day")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
