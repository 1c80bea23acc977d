"""One step of a CfC network for one sample, in PyTorch and in ONNX Runtime: what bench/latency.sh compares with.

  x [1,5], state [1,32], elapsed [1,1]  ->  y [1,3], state [1,32]

ncps' CfCCell with 32 units and a backbone of 64 (lecun_tanh), and a linear layer to three outputs; the same weights in
both, ONNX Runtime reading the graph that torch.onnx writes. One thread, no gradients; the state of a step goes into the
next. Each call is timed by itself; microseconds, lines as the example `latency` prints them.

usage: peers_latency.py [--steps N] [--warm N]
"""
import argparse
import io
import time
import warnings

import numpy as np
import onnxruntime
import torch
from ncps.torch.cfc_cell import CfCCell
from torch import nn

INPUTS, UNITS, BACKBONE, OUTPUTS, ELAPSED = 5, 32, 64, 3, 1e-3


class Network(nn.Module):
    def __init__(self):
        super().__init__()
        self.cell = CfCCell(INPUTS, UNITS, backbone_activation="lecun_tanh", backbone_units=BACKBONE)
        self.out = nn.Linear(UNITS, OUTPUTS)

    def forward(self, x, state, elapsed):
        state, _ = self.cell(x, state, elapsed)
        return self.out(state), state


def in_torch(network):
    elapsed = torch.full((1, 1), ELAPSED)
    state = torch.zeros(1, UNITS)

    def step(x):
        nonlocal state
        y, state = network(torch.from_numpy(x), state, elapsed)
        return y.numpy()

    return step


def in_onnx(network):
    graph = io.BytesIO()
    start = (torch.zeros(1, INPUTS), torch.zeros(1, UNITS), torch.full((1, 1), ELAPSED))
    names = ["x", "state", "elapsed"]
    torch.onnx.export(network, start, graph, dynamo=False, input_names=names, output_names=["y", "next"])
    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = 1
    options.inter_op_num_threads = 1
    session = onnxruntime.InferenceSession(graph.getvalue(), options, providers=["CPUExecutionProvider"])
    elapsed = np.full((1, 1), ELAPSED, np.float32)
    state = np.zeros((1, UNITS), np.float32)

    def step(x):
        nonlocal state
        y, state = session.run(None, {"x": x, "state": state, "elapsed": elapsed})
        return y

    return step


def show(name, step, inputs, warm):
    times = []
    for k, x in enumerate(inputs):
        start = time.perf_counter_ns()
        step(x)
        if k >= warm:
            times.append(time.perf_counter_ns() - start)
    times.sort()
    at = lambda share: times[int((len(times) - 1) * share)] / 1e3
    print(f"{name:<34} {at(0.5):>8.2f} {at(0.99):>8.2f} {at(0.999):>8.2f} {at(1.0):>10.1f}", flush=True)


def main():
    p = argparse.ArgumentParser()
    p.add_argument("--steps", type=int, default=20_000)
    p.add_argument("--warm", type=int, default=2_000)
    a = p.parse_args()
    warnings.filterwarnings("ignore")  # the exporter speaks of its successor
    torch.set_num_threads(1)
    torch.manual_seed(0)
    network = Network().eval()
    inputs = np.random.default_rng(0).standard_normal((a.warm + a.steps, 1, INPUTS)).astype(np.float32)
    with torch.no_grad():
        both = in_torch(network), in_onnx(network)
        for x in inputs[:100]:
            apart = np.abs(both[0](x) - both[1](x)).max()
            assert apart < 1e-5, f"PyTorch and ONNX Runtime differ by {apart}"
        show("PyTorch eager", both[0], inputs, a.warm)
        show("ONNX Runtime", both[1], inputs, a.warm)


main()
