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

from _torch_samples import ANGLES, PITCH, PLACED, ROLL, STANDS, Batch, Body, Dice, Motion, batches

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
    apart = (body.placed(poses, batch.bodies) - batch.joints).index_select(1, body.joints).square().sum(-1)
    astray = poses - batch.truth
    turns = torch.cat([astray[:, :ANGLES].unflatten(-1, (-1, 3)).square().sum(-1), astray[:, PITCH:ROLL + 1].square().sum(-1, keepdim=True)], -1)
    far = ((apart + NEAR ** 2).sqrt() - NEAR).mean() / DISTANCE
    askew = ((turns + STRAIGHT ** 2).sqrt() - STRAIGHT).sum(-1).mean() / (len(body.joints) * ANGLE)
    return far + askew + SAYING * nn.functional.binary_cross_entropy_with_logits(said, batch.stands.float())


class Learning:
    """A network while it is learnt; on a graphics card a step is recorded once and played from then on, nine times as fast as told one by one.

    What changes from step to step lies on the device: the rate, how far the mean follows, and how much loss was heard.
    """

    def __init__(self, body: Body, motion: Motion, net: Net, seed: int):
        self.body, self.net = body, net
        dice = Dice(torch.Generator(body.device).manual_seed(seed), body.device)
        self.stream, self.generator, self.recorded = batches(body, motion, SIZE, dice), dice.generator, None
        truth = torch.cat([next(self.stream).truth for _ in range(2)])
        self.outs = torch.stack([truth.mean(0), truth.std(0).clamp(min=1e-3)])
        self.rate, self.follows, self.heard = (torch.zeros((), device=body.device) for _ in range(3))
        card = body.device == "cuda"
        self.adam = torch.optim.Adam(net.parameters(), lr=self.rate, fused=card, capturable=card)
        self.mean = [value.detach().clone() for value in net.parameters()]

    def step(self) -> None:
        """Learn from one batch more."""
        if self.recorded is None and self.body.device == "cuda":
            self._record()
        if self.recorded is None:
            self._learn()
        else:
            self.recorded.replay()

    def _learn(self) -> None:
        batch = next(self.stream)
        found = self.net(batch.inputs)
        off = loss(self.body, found[:, :PLACED] * self.outs[1] + self.outs[0], found[:, PLACED:], batch)
        self.adam.zero_grad(set_to_none=True)
        off.backward()
        self.adam.step()
        with torch.no_grad():
            for mean, value in zip(self.mean, self.net.parameters(), strict=True):
                mean.add_((value - mean) * self.follows)
            self.heard.add_(off.detach())

    def _record(self) -> None:
        """Three steps must have been gone before one is recorded: at a rate of nothing."""
        rate, follows = self.rate.clone(), self.follows.clone()
        self.rate.zero_(), self.follows.zero_()
        beside = torch.cuda.Stream()
        beside.wait_stream(torch.cuda.current_stream())
        with torch.cuda.stream(beside):
            for _ in range(3):
                self._learn()
        torch.cuda.current_stream().wait_stream(beside)
        self.recorded = torch.cuda.CUDAGraph()
        self.recorded.register_generator_state(self.generator)
        with torch.cuda.graph(self.recorded):
            self._learn()
        self.rate.copy_(rate), self.follows.copy_(follows), self.heard.zero_()


def learn(learning: Learning, count: int, told: Callable[[int, float], None]) -> None:
    """Learn from `count` batches. told: called now and then with the batches done and the mean loss since."""
    for done in range(count):
        learning.rate.fill_(RATE * min(1.0, (done + 1) / min(WARMING, 0.1 * count)) * 0.5 * (1.0 + math.cos(math.pi * done / count)))
        learning.follows.fill_(1.0 - min(MEAN, (done + 1) / (done + 21)))
        learning.step()
        if (done + 1) % SAID == 0 or done + 1 == count:
            told(done + 1, float(learning.heard) / ((done + 1) % SAID or SAID))
            learning.heard.zero_()


def save(path: Path, outs: Tensor, mean: list[Tensor], learnt: int) -> None:
    """Write weights as `scripts/build/trackers.py --weights` reads them, in half precision: what ships has less. learnt: samples."""
    values = [value.detach().cpu().numpy().astype(np.float16) for value in mean]
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
    learning = Learning(body, motion, net, options.seed)
    learn(learning, options.batches, lambda done, off: print(f"batch {done} of {options.batches}: loss {off:.4f}, {time.time() - began:.0f} s", flush=True))
    save(options.out, learning.outs, learning.mean, options.batches * SIZE)


if __name__ == "__main__":
    main()
