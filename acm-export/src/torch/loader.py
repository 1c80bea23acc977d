"""The network of @NAME.safetensors as a torch.nn.Module: one step, with its scalers.

    from @NAME_torch import load
    network = load()
    state = network.start(batch=1)
    residual, state = network.step(channels, elapsed, state)

channels [N, C] in SI units (float64), elapsed [N, 1] in s, residual [N, O] in SI units: what is added to the nominal model.
The state begins anew, and elapsed is first_elapsed, at the first sample and where more than max_gap seconds have passed; a
channel that is a rate is 0 there. The parameters learn like any others: network.parameters().

Run as a program, it compares itself with the recorded steps. Exit code 0: equal within 1e-5 of the outputs' RMS; 1: not;
77: torch, safetensors, or ncps (for a CfC) is not installed.
"""
import json
import pathlib
import sys

try:
    import torch
    from safetensors.torch import load_file
except ImportError as error:
    if __name__ != "__main__":
        raise
    print(f"skipped: {error.name} is not installed; pip install torch safetensors ncps")
    sys.exit(77)

HERE = pathlib.Path(__file__).parent


class LeCunTanh(torch.nn.Module):
    def forward(self, x):
        return 1.7159 * torch.tanh(0.666 * x)


ACTIVATIONS = {
    "lecun_tanh": LeCunTanh,
    "tanh": torch.nn.Tanh,
    "relu": torch.nn.ReLU,
    "silu": torch.nn.SiLU,
    "gelu": torch.nn.GELU,
}


class Estimator(torch.nn.Module):
    def __init__(self, about):
        super().__init__()
        self.about, net = about, about["network"]
        for name in ("inputs", "targets"):
            for what, values in about[name].items():
                self.register_buffer(f"{name}_{what}", torch.tensor(values, dtype=torch.float64), persistent=False)
        none = [[0.0] * net["outputs"]] * (net["inputs"] + 1)
        straight = torch.tensor(about["straight"] or none, dtype=torch.float64)
        self.register_buffer("straight", straight, persistent=False)
        self.kind, self.layers, features = net["kind"], net.get("layers", 1), net.get("units")
        if self.kind == "cfc":
            from ncps.torch import CfCCell

            # The cell, not ncps.torch.CfC: its timespans are wrong for batches.
            self.rnn_cell = CfCCell(
                net["inputs"],
                net["units"],
                mode=net["mode"],
                backbone_activation=net["activation"],
                backbone_units=net["backbone_units"],
                backbone_layers=net["backbone_layers"],
            )
        elif self.kind == "gru":
            self.rnn = torch.nn.GRU(net["inputs"], net["units"], net["layers"])
        else:
            widths, modules = [net["inputs"], *net["hidden"]], []
            for inputs, outputs in zip(widths, widths[1:]):
                modules += [torch.nn.Linear(inputs, outputs), ACTIVATIONS[net["activation"]]()]
            self.layers, features = torch.nn.Sequential(*modules), widths[-1]
        self.fc = torch.nn.Linear(features, net["outputs"])

    def start(self, batch=1):
        """The state before the first sample: [N, H], of a GRU [layers, N, H], of an MLP None."""
        units = self.about["network"].get("units")
        if self.kind == "cfc":
            return torch.zeros(batch, units)
        return torch.zeros(self.layers, batch, units) if self.kind == "gru" else None

    def step(self, channels, elapsed, state):
        x = ((channels.double() - self.inputs_mean) / self.inputs_spread).float()
        if self.kind == "cfc":
            features, state = self.rnn_cell(x, state, elapsed.float())
        elif self.kind == "gru":
            features, state = self.rnn(x.unsqueeze(0), state)
            features = features.squeeze(0)
        else:
            features = self.layers(x)
        residual = self.fc(features).double() * self.targets_spread + self.targets_mean
        # The straight path beside the network: a row for each channel, the last for the constant.
        return residual + x.double() @ self.straight[:-1] + self.straight[-1], state


class Ensemble(torch.nn.Module):
    """Several networks of one shape: the residual is the mean over them, the state a list."""

    def __init__(self, about):
        super().__init__()
        self.about = about
        self.members = torch.nn.ModuleList(Estimator(about) for _ in range(about["members"]))

    def start(self, batch=1):
        return [member.start(batch) for member in self.members]

    def step(self, channels, elapsed, state):
        answers = [member.step(channels, elapsed, own) for member, own in zip(self.members, state)]
        return torch.stack([residual for residual, _ in answers]).mean(0), [own for _, own in answers]


def load(folder=HERE):
    """The network of the files in `folder`."""
    folder = pathlib.Path(folder)
    about = json.loads((folder / "@NAME_torch.json").read_text())
    network = Estimator(about) if about["members"] == 1 else Ensemble(about)
    network.load_state_dict(load_file(folder / "@NAME.safetensors"), strict=True)
    return network


def check():
    network = load()
    recorded = network.about["self_test"]
    sizes, worst, state = torch.tensor(recorded["output_rms"]), 0.0, None
    with torch.no_grad():
        for step in recorded["steps"]:
            # Twice the same sample: what a batch does to one row must not depend on the other.
            channels = torch.tensor([step["channels"]] * 2, dtype=torch.float64)
            elapsed = torch.full((2, 1), step["elapsed"])
            state = network.start(batch=2) if step["begins"] else state
            residual, state = network.step(channels, elapsed, state)
            off = (residual - torch.tensor(step["residual"], dtype=torch.float64)).abs() / sizes
            worst = max(worst, off.max().item())
    print(f"{len(recorded['steps'])} steps: outputs within {worst:.1e} of their RMS")
    return worst <= 1e-5


if __name__ == "__main__":
    try:
        sys.exit(0 if check() else 1)
    except ImportError as error:
        print(f"skipped: {error.name} is not installed; pip install torch safetensors ncps")
        sys.exit(77)
