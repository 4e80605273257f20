"""Changes the code in small ways, one at a time, and sees whether the tests notice: mutants.py COUNT SEED COMMIT.

The changes are drawn from what `cargo mutants --list` finds. Works in a checkout of its own of the commit,
target/mutants/tree; what became of each change is appended to target/mutants/COMMIT-SEED.jsonl, and a run that was
stopped goes on there. Ends with 1 when less than 92 % of the changes that compile are noticed.
"""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
import time
from pathlib import Path

NOTICED_MIN = 0.92
#: What flies, records, verifies and sends. Pictures are left to the eye.
CRATES = {"aircraft", "analysis", "engine", "flightgear", "logs", "recorder", "replay", "tiltrotor"}
PICTURES = ("replay/src/view/", "src/view/")
#: The flight model's tests lie where there is an aircraft to fly.
FLIGHT_MODEL = ("engine", "aircraft", "analysis")
#: Tests of what blessing rewrites: whoever changed the code may have blessed the change.
BLESSED = ("regress_", "listings::", "the_protocol_file_is_the_table", "the_written_validation")
#: A change that makes a loop endless is noticed by this.
PATIENCE_S = 1800
WORK = Path("target/mutants")


def listed(tree: Path) -> list[dict]:
    command = ["cargo", "mutants", "--no-config", "--workspace", "--list", "--json"]
    said = subprocess.run(command, cwd=tree, capture_output=True, text=True, check=True).stdout
    return [
        change
        for change in json.loads(said)
        if change["package"] in CRATES and not change["file"].startswith(PICTURES)
    ]


def passes(tree: Path, packages: list[str], only_build: bool) -> bool:
    """Whether these tests pass, or compile."""
    command = ["cargo", "test", "--quiet", "--no-default-features", "--lib", "--bins", "--tests", *packages]
    if only_build:
        command.append("--no-run")
    else:
        command += ["--", *(word for name in BLESSED for word in ("--skip", name))]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "stdin": subprocess.DEVNULL}
    process = subprocess.Popen(command, cwd=tree, start_new_session=True, **quiet)
    try:
        return process.wait(PATIENCE_S) == 0
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, 9)
        process.wait()
        return False


def fate(tree: Path, change: dict) -> str:
    """What becomes of a change: `unbuilt`, `noticed` or `missed`."""
    package = change["package"]
    near = [word for name in (FLIGHT_MODEL if package in FLIGHT_MODEL else (package,)) for word in ("-p", name)]
    patched = subprocess.run(["patch", "--silent", change["file"]], input=change["diff"], text=True, cwd=tree)
    try:
        if patched.returncode or not passes(tree, near, only_build=True):
            return "unbuilt"
        if not passes(tree, near, only_build=False) or not passes(tree, ["--workspace"], only_build=False):
            return "noticed"
        return "missed"
    finally:
        subprocess.run(["git", "checkout", "--quiet", "--", "."], cwd=tree, check=True)


def main() -> int:
    count, seed = int(sys.argv[1]), int(sys.argv[2])
    WORK.mkdir(parents=True, exist_ok=True)
    head = subprocess.run(["git", "rev-parse", "--short", sys.argv[3]], capture_output=True, text=True, check=True)
    commit, tree = head.stdout.strip(), WORK.resolve() / "tree"
    if not tree.exists():
        subprocess.run(["git", "worktree", "add", "--quiet", "--detach", str(tree), commit], check=True)
    subprocess.run(["git", "checkout", "--quiet", "--force", "--detach", commit], cwd=tree, check=True)
    os.environ.update(
        CARGO_TARGET_DIR=str(WORK.resolve() / "build"),
        CARGO_PROFILE_DEV_DEBUG="0",
        CARGO_INCREMENTAL="1",
        INSTA_UPDATE="no",
    )

    every = listed(tree)
    drawn = random.Random(seed).sample(every, min(count, len(every)))
    book = WORK / f"{commit}-{seed}.jsonl"
    known = [json.loads(line) for line in book.read_text().splitlines()] if book.exists() else []
    fates = {entry["name"]: entry["fate"] for entry in known}
    print(f"{len(drawn)} of {len(every)} changes, seed {seed}, commit {commit}; {len(fates)} known", flush=True)
    if not fates and not passes(tree, ["--workspace"], only_build=False):
        sys.exit("the tests fail without any change")
    for change in drawn:
        name = change["name"]
        if name in fates:
            continue
        begun = time.monotonic()
        fates[name] = fate(tree, change)
        with book.open("a") as file:
            print(json.dumps({"name": name, "fate": fates[name]}), file=file)
        print(f"{fates[name]:<8} {time.monotonic() - begun:4.0f} s  {name}", flush=True)

    fates = {change["name"]: fates[change["name"]] for change in drawn}
    missed = sorted(name for name, what in fates.items() if what == "missed")
    noticed = sum(what == "noticed" for what in fates.values())
    print(*missed, sep="\n")
    part = noticed / max(noticed + len(missed), 1)
    print(f"{noticed} of {noticed + len(missed)} changes that compile noticed, {100 * part:.0f} %, at least {100 * NOTICED_MIN:.0f} %")
    return 0 if part >= NOTICED_MIN else 1


sys.exit(main())
