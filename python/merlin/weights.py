# SPDX-License-Identifier: MIT
"""What is in a weights file, and what its network costs."""
from __future__ import annotations

import json
import os
from typing import Any, Dict, NamedTuple, Optional, Tuple

from . import _headers as h
from ._call import Owner, call, check
from ._library import weights_path
from .pictures import PathLike


class Tensor(NamedTuple):
    """One array of a weights file."""

    name: str  #: such as "encoder.conv1.weight"
    type: str  #: "F16", "F32", "BF16" or "I64"
    shape: Tuple[int, ...]


class Weights:
    """What a weights file says of itself. weights: a shipped name, such as "merlin-any", or a file."""

    def __init__(self, weights: PathLike) -> None:
        path = weights_path(weights)
        self._owner = Owner(h.Weights(), "weights_free")
        check("weights_read", path, self._owner.at, path=os.fsdecode(path))
        struct = self._owner.struct
        self.name: str = struct.name.decode("utf-8", "replace")  #: the model's
        self.parameters: int = struct.parameters  #: trained numbers
        self.statistics: int = struct.statistics  #: running means and variances of batch norms
        self.gmac: float = struct.gmac  #: 10^9 multiplications and additions for one picture of 256 x 256
        self.tensors: Tuple[Tensor, ...] = tuple(
            Tensor(one.name.decode(), one.type.decode(), tuple(one.shape[:one.rank]))
            for one in struct.tensors[:struct.tensor_count])

    def metadata(self, name: str) -> Optional[str]:
        """What the file says under a name, such as "config", "samples", "note" or "training"; None without."""
        said = call("weights_metadata", self._owner.at, name.encode())
        return None if said is None else said.decode("utf-8", "replace")

    @property
    def config(self) -> Dict[str, Any]:
        """The network's configuration (docs/model.md)."""
        return json.loads(self.metadata("config") or "{}")

    def __repr__(self) -> str:
        return f"<merlin.Weights {self.name}, {self.parameters} parameters>"
