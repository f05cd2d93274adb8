"""Rigid motions and their twists, and a skeleton as a product of exponentials: sections 2.1 and 2.2 of Rosenhahn 2007.

Twists are (v, ω): three of translation [m], then three of rotation [rad].
"""

from .kinematic_chain import FULL, PAPER, Chain, Configuration, chain_of, fitted, local_turns, posed, product_of_exponentials
from .rigid_motions import adjoint, bracket, exp, hat, inverse, log, rigid, vee
from .twist_kernels import chain_kernel, retract_kernel, turn_log_kernel, twist_exp_kernel, twist_log_kernel

__all__ = [
    "FULL", "PAPER", "Chain", "Configuration", "adjoint", "bracket", "chain_kernel", "chain_of", "exp", "fitted", "hat",
    "inverse", "local_turns", "log", "posed", "product_of_exponentials", "retract_kernel", "rigid", "turn_log_kernel", "twist_exp_kernel",
    "twist_log_kernel", "vee",
]
