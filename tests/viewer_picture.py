"""A picture of a running rerun viewer: PORT FILE. Waits until the file is whole, for the viewer answers before it is."""

import os
import sys
import time

from rerun.experimental import ViewerClient

port, name = sys.argv[1:]
ViewerClient(f"rerun+http://127.0.0.1:{port}/proxy").save_screenshot(os.path.abspath(name))
size = -1
for _ in range(80):
    time.sleep(0.5)
    before, size = size, os.path.getsize(name) if os.path.exists(name) else -1
    if 0 < size == before:
        break
