"""Compares @NAME.onnx with the recorded vectors of @NAME_onnx.json, by ONNX Runtime.

    python @NAME_onnx_check.py

Exit code 0: equal within 1e-5 of the outputs' RMS; 1: not; 77: onnxruntime or numpy is not installed.
"""
import json
import pathlib
import sys

try:
    import numpy as np
    import onnxruntime
except ImportError as error:
    print(f"skipped: {error.name} is not installed; pip install onnxruntime numpy")
    sys.exit(77)

here = pathlib.Path(__file__).parent
about = json.loads((here / "@NAME_onnx.json").read_text())
session = onnxruntime.InferenceSession(str(here / "@NAME.onnx"), providers=["CPUExecutionProvider"])
wanted = {value.name: value for value in session.get_inputs()}
has_state = "state" in wanted
state = np.zeros((1, wanted["state"].shape[1]), np.float32) if has_state else None

worst = 0.0
for step in about["self_test"]["steps"]:
    feed = {"channels": np.array([step["channels"]])}
    if "elapsed" in wanted:
        feed["elapsed"] = np.array([[step["elapsed"]]], np.float32)
    if has_state:
        feed["state"] = np.zeros_like(state) if step["begins"] else state
    found = dict(zip([value.name for value in session.get_outputs()], session.run(None, feed)))
    state = found.get("next_state")
    off = np.abs(found["residual"][0] - np.array(step["residual"]))
    worst = max(worst, float(np.max(off / np.array(about["self_test"]["output_rms"]))))

print(f"{len(about['self_test']['steps'])} steps: outputs within {worst:.1e} of their RMS")
sys.exit(0 if worst <= 1e-5 else 1)
