"""What all that users write and name have in common: TOML files, misspelt names, and paths that results go to."""

from . import toml
from .did_you_mean import did_you_mean, meant
from .frame_rate import frame_rate, plain
from .paths import OutputError, exclusive, named, output_file, output_folder, whole

__all__ = [
    "OutputError", "did_you_mean", "exclusive", "frame_rate", "meant", "named", "output_file", "output_folder", "plain", "toml", "whole",
]
