"""Changes the code in small ways, one at a time, and sees whether the tests notice: mutants.py [COUNT [SEED [COMMIT]]].

The changes are drawn from what `cargo mutants --list` finds in COMMIT, and made to HEAD, whose tests they meet: a
sample stays the same while tests are added. Works in a checkout of its own, target/mutants/tree; what became of each
change stands in tests/mutants/COMMIT-SEED.jsonl, and a run that was stopped goes on there. Changes that were missed
are tried once more with `--again`; what is noticed then keeps `first`: "missed". To one that stays missed a person
adds `why`. Ends with 1 when less than 92 % of the changes that compile are noticed.
"""

from __future__ import annotations

import argparse
import json
import os
import random
import re
import resource
import subprocess
import sys
import tempfile
import time
from functools import partial
from pathlib import Path

NOTICED_MIN = 0.92
#: What flies, records, verifies and sends. Pictures are left to the eye.
CRATES = {"aircraft", "analysis", "engine", "flightgear", "logs", "recorder", "replay", "tiltrotor"}
PICTURES = ("replay/src/view/", "src/view/")
#: What is compiled on other systems than Linux, or with the viewer: no test here can notice.
ELSEWHERE = (
    "src/fly/live.rs",
    "recorder/src/devices/gamepads.rs",
    "recorder/src/platform/portable.rs",
    "recorder/src/platform/without_unix.rs",
)
#: The flight model's tests lie where there is an aircraft to fly. Golden flights and the corpus are its own output,
#: which blessing rewrites: what they alone notice does not count, so that its changes meet no test that reads them.
FLIGHT_MODEL = ("engine", "aircraft", "analysis")
FLOWN = (["-p", "recorder", "--tests"], ["-p", "tiltrotor", "--test", "command"])
FLOWN_COMMANDS = ("identify::", "second_aircraft::", "steady::")
#: Tests of what blessing rewrites: whoever changed the code may have blessed the change.
BLESSED = ("regress_", "listings::", "the_protocol_file_is_the_table", "the_written_validation")
#: Tests that a busy machine can fail: what they notice may be the machine.
TIMED = ("pictures_are_smooth",)
#: A change that makes a loop endless is noticed by the first, of one process and whatever else the machine does; one
#: that makes a test wait for ever by the second.
CPU_S, PATIENCE_S = 900, 7200
WORK, BOOKS = Path("target/mutants"), Path("tests/mutants")


def listed(tree: Path) -> list[dict]:
    command = ["cargo", "mutants", "--no-config", "--workspace", "--list", "--json"]
    said = subprocess.run(command, cwd=tree, capture_output=True, text=True, check=True).stdout
    return [
        change
        for change in json.loads(said)
        if change["package"] in CRATES and not change["file"].startswith(PICTURES)
    ]


def failure(tree: Path, tests: list[str], only_build: bool = False) -> str | None:
    """The first of these tests that fails, or that they do not compile; none if they pass."""
    command = ["cargo", "test", "--no-default-features", *tests]
    # Without the viewer, which would be linked anew for every change.
    if sticks := [f"{name}/sticks" for name in ("recorder", "tiltrotor") if name in tests or "--workspace" in tests]:
        command += ["--features", ",".join(sticks)]
    if only_build:
        command.append("--no-run")
    else:
        command += ["--", "--fail-fast", "-Zunstable-options"]
        command += [word for name in (*BLESSED, *TIMED) for word in ("--skip", name)]
        command += FLOWN_COMMANDS if tests == FLOWN[-1] else ()
    limit = partial(resource.setrlimit, resource.RLIMIT_CPU, (CPU_S, CPU_S))
    with tempfile.TemporaryFile("w+", errors="replace") as said:
        process = subprocess.Popen(
            command, cwd=tree, stdin=subprocess.DEVNULL, stdout=said, stderr=said, start_new_session=True, preexec_fn=limit
        )
        try:
            if process.wait(PATIENCE_S) == 0:
                return None
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, 9)
            process.wait()
        said.seek(0)
        text = said.read()
    failed = re.search(r"^test (\S+).* FAILED$", text, re.MULTILINE)
    return failed[1] if failed else (text.strip().splitlines() or ["no word"])[-1]


def make(tree: Path, change: dict) -> bool:
    """Makes the change in its file, or, where that is not what it was, to the only such lines of its crate."""
    file = tree / change["file"]
    command = ["patch", "--silent", "--force", "--fuzz=3", "--no-backup-if-mismatch", "--reject-file=-"]
    command.append(str(file))
    trial = subprocess.run([*command, "--dry-run"], input=change["diff"], text=True, capture_output=True)
    if trial.returncode == 0:
        return subprocess.run(command, input=change["diff"], text=True, capture_output=True).returncode == 0

    hunk = change["diff"].splitlines()[2:]
    old, new = ("".join(line[1:] + "\n" for line in hunk if line[:1] == sign) for sign in "-+")
    sources = next(folder for folder in file.parents if folder.name == "src")
    found = [file for file in sources.rglob("*.rs") if old in file.read_text()]
    if len(found) != 1 or (text := found[0].read_text()).count(old) != 1:
        return False
    found[0].write_text(text.replace(old, new))
    return True


def fate(tree: Path, change: dict) -> dict:
    """What becomes of a change: `unbuilt`, `gone` (its lines are not there any more), `noticed` and by which test, or
    `missed`."""
    own = ["-p", change["package"], "--tests"]
    near = [*(word for name in FLIGHT_MODEL for word in ("-p", name)), "--tests"]
    stages = [own, near, *FLOWN] if change["package"] in FLIGHT_MODEL else [own, ["--workspace", "--tests"]]
    if change["file"] in ELSEWHERE:
        return {"fate": "unbuilt"}
    try:
        if not make(tree, change):
            return {"fate": "gone"}
        if failure(tree, own, only_build=True):
            return {"fate": "unbuilt"}
        by = next(filter(None, (failure(tree, stage) for stage in stages)), None)
        return {"fate": "noticed", "by": by} if by else {"fate": "missed"}
    finally:
        subprocess.run(["git", "checkout", "--quiet", "--", "."], cwd=tree, check=True)


def drawn(tree: Path, count: int, seed: int, commit: str) -> list[dict]:
    """The sample of the commit; kept beside the tree, for the listing takes a while."""
    kept = WORK / f"{commit}-{seed}-{count}.json"
    if not kept.exists():
        subprocess.run(["git", "checkout", "--quiet", "--force", "--detach", commit], cwd=tree, check=True)
        every = listed(tree)
        print(f"{len(every)} changes in {commit}", flush=True)
        kept.write_text(json.dumps(random.Random(seed).sample(every, min(count, len(every)))))
    return json.loads(kept.read_text())


def main() -> int:
    parser = argparse.ArgumentParser(description="Would the tests notice small changes to the code?")
    parser.add_argument("count", nargs="?", type=int, default=200)
    parser.add_argument("seed", nargs="?", type=int, default=1)
    parser.add_argument("commit", nargs="?", default="HEAD")
    parser.add_argument("--again", action="store_true", help="try what was missed once more")
    args = parser.parse_args()
    count, seed = args.count, args.seed
    WORK.mkdir(parents=True, exist_ok=True)
    commit, head = (
        subprocess.run(["git", "rev-parse", "--short", of], capture_output=True, text=True, check=True).stdout.strip()
        for of in (args.commit, "HEAD")
    )
    tree = WORK.resolve() / "tree"
    if not tree.exists():
        subprocess.run(["git", "worktree", "add", "--quiet", "--detach", str(tree), head], check=True)
    os.environ.update(
        CARGO_TARGET_DIR=str(WORK.resolve() / "build"),
        CARGO_PROFILE_DEV_DEBUG="0",
        CARGO_INCREMENTAL="1",
        INSTA_UPDATE="no",
        # libtest stops at the first failure, which it still calls unstable: for the tests alone, not for what compiles.
        CARGO_TARGET_X86_64_UNKNOWN_LINUX_GNU_RUNNER="env RUSTC_BOOTSTRAP=1",
    )
    sample = drawn(tree, count, seed, commit)
    subprocess.run(["git", "checkout", "--quiet", "--force", "--detach", head], cwd=tree, check=True)
    # One of the tests asks for every package's licence.
    subprocess.run(["cargo", "fetch", "--locked", "--quiet"], cwd=tree, check=True)

    BOOKS.mkdir(exist_ok=True)
    book = BOOKS / f"{commit}-{seed}.jsonl"
    lines = book.read_text().splitlines() if book.exists() else []
    fates = {entry["name"]: entry for entry in map(json.loads, lines)}
    print(f"{len(sample)} changes, seed {seed}, of {commit}, with the tests of {head}; {len(fates)} known", flush=True)
    if not fates and (why := failure(tree, ["--workspace", "--tests"])):
        sys.exit(f"the tests fail without any change: {why}")
    # Crate by crate: what one change had built anew, the next one needs.
    for change in sorted(sample, key=lambda change: change["package"]):
        name = change["name"]
        known = fates.get(name)
        if known and not (args.again and known["fate"] == "missed"):
            continue
        begun = time.monotonic()
        what = {"name": name, **fate(tree, change)}
        if known:
            what |= {"first": "missed"} if what["fate"] == "noticed" else {"why": known.get("why")}
        fates[name] = what
        book.write_text("".join(json.dumps(entry) + "\n" for entry in fates.values()))
        print(f"{what['fate']:<8} {time.monotonic() - begun:4.0f} s  {name}: {what.get('by', '')}", flush=True)

    fates = {change["name"]: fates[change["name"]] for change in sample}
    missed = sorted(name for name, what in fates.items() if what["fate"] == "missed")
    noticed = [what for what in fates.values() if what["fate"] == "noticed"]
    since = sum(what.get("first") == "missed" for what in noticed)
    for name in missed:
        print(f"missed: {name}: {fates[name].get('why') or 'no reason given'}")
    compiled = len(noticed) + len(missed)
    part = len(noticed) / max(compiled, 1)
    print(
        f"{len(noticed)} of {compiled} changes that compile noticed, {100 * part:.0f} %, at least {100 * NOTICED_MIN:.0f} %"
        f"; {since} of them missed at first"
    )
    return 0 if part >= NOTICED_MIN else 1


sys.exit(main())
