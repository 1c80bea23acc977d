"""Trains a torch.nn.GRU on the robot of formulas for a few steps, and leaves it for `acm-eval import`.

    python train_gru.py DATA OUT

Leaves OUT/gru.safetensors, OUT/gru.pt and OUT/gru_torch.json, and prints the errors on held-out trials in m as JSON. Shares no
code with acm: windows, rates of change, scalers and errors are its own. Exit code 77: torch, numpy or safetensors is not installed.
"""
import csv
import json
import pathlib
import sys

try:
    import numpy as np
    import torch
    from safetensors.torch import save_file
except ImportError as error:
    print(f"skipped: {error.name} is not installed; pip install torch numpy safetensors")
    sys.exit(77)

LENGTH, MAX_GAP, UNITS = 6, 0.5, 7


def windows(file):
    """Channels q1 (rad), its rate and wind (1) as [N, LENGTH, 3]; x and y (m) at the last sample as [N, 2]."""
    with open(file) as text:
        table = np.array([[float(cell) for cell in row] for row in list(csv.reader(text))[1:]])
    time, q1, wind, measured = table[:, 0], np.radians(table[:, 1]), 0.01 * table[:, 3], 1e-3 * table[:, 4:6]
    gap = np.diff(time) > MAX_GAP
    rate = np.concatenate([[0.0], np.where(gap, 0.0, np.diff(q1) / np.diff(time))])
    begins = np.concatenate([[0], np.cumsum(gap)])
    channels = np.stack([q1, rate, wind], axis=1)
    ends = [k for k in range(LENGTH - 1, len(time)) if begins[k] == begins[k - LENGTH + 1]]
    return np.stack([channels[k - LENGTH + 1 : k + 1] for k in ends]), measured[ends]


def together(data, trials):
    parts = [windows(data / f"{trial}.csv") for trial in trials]
    return np.concatenate([part[0] for part in parts]), np.concatenate([part[1] for part in parts])


class Network(torch.nn.Module):
    def __init__(self):
        super().__init__()
        self.core = torch.nn.GRU(3, UNITS, batch_first=True)
        self.readout = torch.nn.Linear(UNITS, 2)

    def forward(self, windows):
        return self.readout(self.core(windows)[0][:, -1])


def main(data, out):
    torch.manual_seed(1)
    torch.set_num_threads(1)
    channels, measured = together(data, ["d1", "d2", "d3"])
    scaler = {"mean": channels.mean((0, 1)), "spread": 1.5 * channels.std((0, 1))}
    target = {"mean": measured.mean(0) + 0.01, "spread": 0.7 * measured.std(0)}
    standard = lambda x: torch.tensor((x - scaler["mean"]) / scaler["spread"], dtype=torch.float32)
    wanted = torch.tensor((measured - target["mean"]) / target["spread"], dtype=torch.float32)
    network, seen = Network(), standard(channels)
    optimizer = torch.optim.Adam(network.parameters(), lr=0.02)
    for _ in range(60):
        optimizer.zero_grad()
        torch.nn.functional.mse_loss(network(seen), wanted).backward()
        optimizer.step()

    save_file(network.state_dict(), out / "gru.safetensors")
    torch.save(network.state_dict(), out / "gru.pt")
    about = {
        "network": {"kind": "gru", "units": UNITS, "layers": 1},
        "channels": [{"signal": "q1"}, {"signal": "q1", "rate": True}, {"signal": "wind"}],
        "inputs": {name: list(values) for name, values in scaler.items()},
        "targets": {name: list(values) for name, values in target.items()},
    }
    (out / "gru_torch.json").write_text(json.dumps(about))

    channels, measured = together(data, ["h1", "h2"])
    with torch.no_grad():
        found = network(standard(channels)).double().numpy() * target["spread"] + target["mean"]
    squares = ((found - measured) ** 2).mean(0)
    constant = ((measured - measured.mean(0)) ** 2).mean(0)
    print(json.dumps({"samples": len(found), "rmse": list(squares**0.5), "constant": list(constant**0.5)}))


main(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]))
