"""Check an RO-Crate against a profile by roc-validator, without network: the context of RO-Crate is a file here."""

from __future__ import annotations

from collections import defaultdict
from io import BytesIO
from pathlib import Path
from typing import Any

CONTEXT_ADDRESS = "https://w3id.org/ro/crate/1.1/context"
CONTEXT = Path(__file__).with_name("ro_crate_1.1_context.jsonld")
"""What is published at the address, under CC0."""


def find_issues(crate: Path, profile: str, cache: Path) -> dict[str, set[str]]:
    """Messages about a crate by their severity; cache: a path for the answers that stand in for the network."""
    from rocrate_validator import models, services

    fill_cache(cache)
    settings = services.ValidationSettings(
        rocrate_uri=crate,
        profile_identifier=profile,
        requirement_severity=models.Severity.OPTIONAL,
        offline=True,
        cache_path=cache,
    )
    issues = defaultdict(set)
    for issue in services.validate(settings).get_issues():
        issues[issue.severity.name].add(issue.message)
    return dict(issues)


def fill_cache(cache: Path) -> None:
    """Store the context as if it had been fetched."""
    from requests.adapters import HTTPAdapter
    from requests_cache import CachedSession
    from urllib3 import HTTPResponse

    class Stored(HTTPAdapter):
        """Answers every request with the context."""

        def send(self, request: Any, **options: Any) -> Any:
            headers = {"Content-Type": "application/ld+json"}
            body = BytesIO(CONTEXT.read_bytes())
            answer = HTTPResponse(body, headers, 200, preload_content=False, request_url=request.url)
            return self.build_response(request, answer)

    with CachedSession(str(cache), backend="sqlite", expire_after=-1) as session:
        session.mount("https://", Stored())
        session.get(CONTEXT_ADDRESS)
