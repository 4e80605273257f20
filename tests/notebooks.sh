#!/usr/bin/env bash
# The notebooks of python/notebooks, run from top to bottom in an environment of their own: no cell may fail. What is
# committed holds no outputs.
# Usage: tests/notebooks.sh [TILTROTOR]   (a headless release build without one. After tests/python.sh; PyPI once)
# Ends with 77 where there is no wheel, no Python with venv and pip, or no network to get what it needs.
set -euo pipefail
cd "$(dirname "$0")/.."
source tests/venv.sh

wheel=$(ls -t target/python/wheels/tiltrotor-*.whl 2>/dev/null | head -1 || true)
if [ -z "$wheel" ]; then
    echo "skipped: tests/python.sh builds the package first"
    exit 77
fi
tiltrotor=${1:-}
if [ -z "$tiltrotor" ]; then
    cargo build --release --no-default-features --target-dir target/headless
    tiltrotor=target/headless/release/tiltrotor
fi
venv=target/venv-notebooks
make_venv_of "$venv" python/notebooks/requirements.txt
"$venv/bin/pip" install --quiet --disable-pip-version-check --force-reinstall --no-deps "$wheel"

begun=$SECONDS
out=$PWD/target/notebooks
rm -rf "$out"
# Relative links lead from where the notebooks are; the pictures are in what comes out.
TILTROTOR=$(realpath "$tiltrotor") MPLBACKEND=module://matplotlib_inline.backend_inline \
    "$venv/bin/python" -m nbconvert --log-level WARN --to notebook --execute --output-dir "$out" python/notebooks/*.ipynb
"$venv/bin/python" - "$out" <<'PYTHON'
import json
import sys
from pathlib import Path

for path in sorted(Path("python/notebooks").glob("*.ipynb")):
    cells = [cell for cell in json.loads(path.read_text())["cells"] if cell["cell_type"] == "code"]
    assert not any(cell["outputs"] or cell["execution_count"] for cell in cells), f"{path}: clear its outputs"
    run = [cell for cell in json.loads((Path(sys.argv[1]) / path.name).read_text())["cells"] if cell["cell_type"] == "code"]
    given = [output for cell in run for output in cell["outputs"]]
    pictures = sum("image/png" in output.get("data", {}) for output in given)
    assert len(run) == len(cells) and all(cell["execution_count"] for cell in run) and pictures, path
    print(f"{path}: {len(cells)} cells, {pictures} pictures")
PYTHON
echo "notebooks: run in $((SECONDS - begun)) s"
