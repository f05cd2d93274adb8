"""Learn the network for trackers with PyTorch, on a graphics card in minutes; `scripts/build/trackers.py` packs the motion and ships what is learnt.

    python scripts/build/trackers_torch.py PACK --out WEIGHTS.npz [--batches 9753] [--seed 0]

PACK: what `scripts/build/trackers.py LARGE --small FOLDER --work FOLDER --pack PACK` wrote; neither Gambol nor its motion need be where this runs,
only numpy and PyTorch, and `_torch_samples.py` beside this. The loss is that of `controllers/reconstruction/trackers/learning.py`.
"""

from __future__ import annotations

import argparse
import math
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import torch
from torch import Tensor, nn

from _torch_samples import ANGLES, PITCH, PLACED, ROLL, STANDS, Batch, Body, Motion, batches

SIZE, RATE, WARMING, MEAN, SAID = 4096, 1.5e-3, 500, 0.999, 1000
NEAR, DISTANCE, STRAIGHT, ANGLE, SAYING = 0.01, 0.05, math.radians(2.0), math.radians(10.0), 0.1
"""The loss: a joint's distance over DISTANCE [m], a turn over ANGLE [rad], both by their squares below NEAR and STRAIGHT; contacts weigh SAYING."""


class Net(nn.Module):
    """Layers with ReLU; those between the first and the last add to what they are given."""

    def __init__(self, inputs: int, widths: tuple[int, ...], dropped: float):
        super().__init__()
        sizes = [inputs, *widths, PLACED + STANDS]
        self.layers = nn.ModuleList([nn.Linear(a, b) for a, b in zip(sizes[:-1], sizes[1:], strict=True)])
        self.dropped, self.last = dropped, len(widths)
        for number, layer in enumerate(self.layers):
            share = 1.0 if number == self.last else 2.0
            nn.init.normal_(layer.weight, std=math.sqrt(share / layer.in_features) * (0.5 if 0 < number < self.last else 1.0))
            nn.init.zeros_(layer.bias)

    def forward(self, x: Tensor) -> Tensor:
        for number, layer in enumerate(self.layers):
            y = torch.relu(layer(x)) if number < self.last else layer(x)
            x = x + y if 0 < number < self.last else y
            if number < self.last:
                x = nn.functional.dropout(x, self.dropped, self.training)
        return x


def loss(body: Body, poses: Tensor, said: Tensor, batch: Batch) -> Tensor:
    """See `learning.loss`. poses: (B, 63). said: (B, 4) contacts' logits."""
    apart = (body.placed(poses, batch.bodies) - batch.joints)[:, body.joints].square().sum(-1)
    astray = poses - batch.truth
    turns = torch.cat([astray[:, :ANGLES].unflatten(-1, (-1, 3)).square().sum(-1), astray[:, [PITCH, ROLL]].square().sum(-1, keepdim=True)], -1)
    far = ((apart + NEAR ** 2).sqrt() - NEAR).mean() / DISTANCE
    askew = ((turns + STRAIGHT ** 2).sqrt() - STRAIGHT).sum(-1).mean() / (len(body.joints) * ANGLE)
    return far + askew + SAYING * nn.functional.binary_cross_entropy_with_logits(said, batch.stands.float())


def learn(body: Body, motion: Motion, net: Net, count: int, seed: int, told: Callable[[int, float], None]) -> tuple[Tensor, list[Tensor]]:
    """Means and deviations (2, 63) of poses, and the running mean of the weights after `count` batches.

    told: called now and then with the batches done and the mean loss since.
    """
    stream = batches(body, motion, SIZE, seed)
    truth = torch.cat([next(stream).truth for _ in range(2)])
    outs = torch.stack([truth.mean(0), truth.std(0).clamp(min=1e-3)])
    adam = torch.optim.Adam(net.parameters(), lr=RATE, fused=body.device == "cuda")
    mean, heard = [value.detach().clone() for value in net.parameters()], torch.zeros((), device=body.device)
    for done in range(count):
        batch = next(stream)
        found = net(batch.inputs)
        off = loss(body, found[:, :PLACED] * outs[1] + outs[0], found[:, PLACED:], batch)
        adam.zero_grad(set_to_none=True)
        adam.param_groups[0]["lr"] = RATE * min(1.0, (done + 1) / min(WARMING, 0.1 * count)) * 0.5 * (1.0 + math.cos(math.pi * done / count))
        off.backward()
        adam.step()
        with torch.no_grad():
            torch._foreach_lerp_(mean, list(net.parameters()), 1.0 - min(MEAN, (done + 1) / (done + 21)))
            heard += off
            if (done + 1) % SAID == 0 or done + 1 == count:
                told(done + 1, float(heard) / ((done + 1) % SAID or SAID))
                heard.zero_()
    return outs, mean


def save(path: Path, outs: Tensor, mean: list[Tensor], learnt: int) -> None:
    """Write weights as `scripts/build/trackers.py --weights` reads them. learnt: samples."""
    values = [value.detach().cpu().numpy() for value in mean]
    np.savez(path, outs=outs.cpu().numpy(), learnt=learnt,
             **{f"weights{i}": np.ascontiguousarray(value.T) for i, value in enumerate(values[::2])},
             **{f"biases{i}": value for i, value in enumerate(values[1::2])})


def main() -> None:
    """Learn one network."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pack", type=Path, metavar="PACK")
    parser.add_argument("--out", type=Path, required=True, metavar="WEIGHTS.npz")
    parser.add_argument("--batches", type=int, default=9_753, help=f"of {SIZE} samples")
    parser.add_argument("--widths", type=int, nargs="+", default=[1536, 1536, 1536])
    parser.add_argument("--dropped", type=float, default=0.05, help="share of hidden layers that is left out at a time")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    device = "cuda" if torch.cuda.is_available() else "cpu"
    torch.backends.cuda.matmul.allow_tf32 = True  # of layers; kinematics have no such product
    with np.load(options.pack) as file:
        pack = {name: file[name] for name in file.files}
    body = Body(pack, device)
    motion = Motion(pack, body)
    torch.manual_seed(options.seed)
    net, began = Net(int(pack["inputs"]), tuple(options.widths), options.dropped).to(device), time.time()
    outs, mean = learn(body, motion, net, options.batches, options.seed,
                       lambda done, off: print(f"batch {done} of {options.batches}: loss {off:.4f}, {time.time() - began:.0f} s", flush=True))
    save(options.out, outs, mean, options.batches * SIZE)


if __name__ == "__main__":
    main()
