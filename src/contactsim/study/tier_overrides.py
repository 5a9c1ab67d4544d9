"""What a tier changes in a file of settings.

Overrides are laid over the settings before these are read, so that they are checked by the same tables.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from contactsim.errors import InputError
from contactsim.study.plain_yaml import load_yaml


@dataclass(frozen=True)
class TieredFile:
    """A file beside tiers.yaml with what a tier changes in it; messages name both."""

    file: Path
    tier: str

    @property
    def tiers(self) -> Path:
        """File of the tiers."""
        return self.file.with_name("tiers.yaml")

    def __str__(self) -> str:
        return f"{self.file} with tier {self.tier} of {self.tiers}"


def tiered(file: Path, over: dict, tier: str) -> tuple[dict, Path | TieredFile] | None:
    """Return the mapping in a file beside tiers.yaml with the overrides of a tier, and its name for messages.

    None without that file; InputError where a tier overrides a file that does not exist.
    """
    tiers = file.with_name("tiers.yaml")
    if not file.exists():
        if over:
            raise InputError(f"{tier}.{file.stem}", over, f"left out, as there is no {file}", tiers)
        return None
    return overlaid(load_yaml(file), over), TieredFile(file, tier) if over else file


def overlaid(base: dict, over: dict) -> dict:
    """Return `base` with the entries of `over` in their place: mappings are merged, null removes a key."""
    merged = dict(base)
    for name, value in over.items():
        if value is None and name in merged:
            del merged[name]
            continue
        both = isinstance(value, dict) and isinstance(merged.get(name), dict)
        merged[name] = overlaid(merged[name], value) if both else value
    return merged
