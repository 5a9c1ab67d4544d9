"""Select the effects that a variant of a study neglects."""

from __future__ import annotations

from contactsim.error_control.neglect import Decision, decide_neglect, decision_digest
from contactsim.provenance import digest
from contactsim.study.scenes import build_setup
from contactsim.study.stages import computing_stage_digest


def select_effects(settings: dict) -> Decision:
    """Decide what is negligible in a variant, on a sample of its members.

    Parameters
    ----------
    settings : dict
        Settings of a run of the variant, with a section `auto`.
    """
    auto = settings["auto"]
    samples = [build_setup(settings | {"member": member}) for member in range(auto["sample"])]
    return decide_neglect(samples, auto["neglect_within"], auto["quantities"])


def selection_digest() -> str:
    """Return a digest of what selects: the code and the maps."""
    return digest(computing_stage_digest("select_effects"), decision_digest())
