"""A page fetched because its address was given: over http or https alone, with a time and a size limit."""

from __future__ import annotations

import urllib.request
from urllib.error import HTTPError, URLError

from regdb.version import VERSION
from regdb_compiler.official.passage import UnreadableTextError

MOST_BYTES = 30_000_000
"""The whole vehicle code is under four million."""

SECONDS = 30.0


def is_address(source: str) -> bool:
    return source.startswith(("http://", "https://"))


def fetch(address: str, seconds: float = SECONDS, most: int = MOST_BYTES) -> bytes:
    """The bytes at an address. Raises UnreadableTextError, saying why they could not be had."""
    if not is_address(address):
        raise UnreadableTextError(f"{address} is no http address")
    request = urllib.request.Request(address, headers={"User-Agent": f"regdb/{VERSION}", "Accept": "text/html, application/xml, text/plain"})
    try:
        with _opener().open(request, timeout=seconds) as answer:
            data: bytes = answer.read(most + 1)
    except HTTPError as error:
        with error:
            raise UnreadableTextError(f"{address} answers {error.code} {error.reason}") from error
    except URLError as error:
        raise UnreadableTextError(f"{address} cannot be reached: {error.reason}") from error
    except (OSError, ValueError) as error:
        raise UnreadableTextError(f"{address} cannot be reached: {error}") from error
    if len(data) > most:
        raise UnreadableTextError(f"{address} is larger than {most / 1e6:g} MB")
    return data


def _opener() -> urllib.request.OpenerDirector:
    """Knows http and https alone, so that no redirection leads to a file or elsewhere."""
    opener = urllib.request.OpenerDirector()
    for handler in (
        urllib.request.ProxyHandler, urllib.request.HTTPHandler, urllib.request.HTTPSHandler, urllib.request.HTTPRedirectHandler,
        urllib.request.HTTPDefaultErrorHandler, urllib.request.HTTPErrorProcessor, urllib.request.UnknownHandler,
    ):  # fmt: skip
        opener.add_handler(handler())
    return opener
