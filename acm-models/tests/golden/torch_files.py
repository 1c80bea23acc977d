"""Files of torch with networks whose numbers are known, and the reading back of what is written for torch.

    python torch_files.py make             writes the files beside this script
    python torch_files.py check FOLDER     reads FOLDER/<name>.safetensors of each network and holds its numbers against
                                           networks.json; prints `<name> ok`

Needs torch, ncps, safetensors and numpy. The committed files were made with torch 2.15.0, ncps 1.0.1 and safetensors 0.8.0.
Rule of the numbers: README.md beside this script.
"""

import json
import math
import pathlib
import sys

import torch
from ncps.torch import CfCCell
from safetensors.torch import load_file, save_file

HERE = pathlib.Path(__file__).resolve().parent
BATCH, STEPS, CHANNELS, UNITS = 3, 6, 4, 5


def cfc(mode, layers):
    return CfCCell(CHANNELS, UNITS, mode=mode, backbone_units=7, backbone_layers=layers)


def networks():
    return {
        "cfc_default_L0": cfc("default", 0),
        "cfc_default_L1": cfc("default", 1),
        "cfc_default_L2": cfc("default", 2),
        "cfc_no_gate_L1": cfc("no_gate", 1),
        "cfc_pure_L2": cfc("pure", 2),
        "gru_1": torch.nn.GRU(CHANNELS, UNITS, batch_first=True),
        "gru_2": torch.nn.GRU(CHANNELS, UNITS, num_layers=2, batch_first=True),
    }


def fill(network):
    count = 0
    with torch.no_grad():
        for parameter in network.parameters():
            k = torch.arange(count, count + parameter.numel(), dtype=torch.float64)
            parameter.copy_((0.3 * torch.sin(0.7 * k + 0.1)).reshape(parameter.shape))
            count += parameter.numel()


def answer(network):
    """The number that networks.json has of every one: the sum of the last states of a cell, of all outputs of a GRU."""
    x = torch.tensor(
        [[[math.sin(0.5 * (b + 1) + 0.3 * t + 0.9 * f) for f in range(CHANNELS)] for t in range(STEPS)] for b in range(BATCH)]
    )
    dt = torch.tensor([[0.02 * (1 + (3 * b + 2 * t) % 5) for t in range(STEPS)] for b in range(BATCH)])
    if isinstance(network, torch.nn.GRU):
        return network(x)[0].sum().item()
    h = torch.zeros(BATCH, UNITS)
    for t in range(STEPS):
        h, _ = network(x[:, t], h, dt[:, t : t + 1])
    return h.sum().item()


def expected(name):
    golden = json.loads((HERE / "networks.json").read_text())[name]
    return golden["sum_zero" if name.startswith("gru") else "sum"]


def held(name, network):
    with torch.no_grad():
        off = abs(answer(network) - expected(name))
    assert off < 1e-5, f"{name} is off by {off}"


def make():
    for name, network in networks().items():
        fill(network)
        held(name, network)
        torch.save(network.state_dict(), HERE / f"{name}.pt")
        save_file(network.state_dict(), HERE / f"{name}.safetensors")


def check(folder):
    for name, network in networks().items():
        network.load_state_dict(load_file(folder / f"{name}.safetensors"), strict=True)
        held(name, network)
        print(name, "ok")


if __name__ == "__main__":
    if sys.argv[1:] == ["make"]:
        make()
    elif sys.argv[1:2] == ["check"] and len(sys.argv) == 3:
        check(pathlib.Path(sys.argv[2]))
    else:
        sys.exit(__doc__)
