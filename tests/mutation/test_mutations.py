"""Every mutation can still be applied: `tests.mutation.run` takes too long to be run each time."""

from __future__ import annotations

import pytest

from tests.mutation.mutations import MUTATIONS, Mutation
from tests.mutation.run import ROOT


@pytest.mark.parametrize("mutation", MUTATIONS, ids=lambda mutation: mutation.name)
def test_what_it_replaces_stands_once(mutation: Mutation) -> None:
    assert (ROOT / mutation.file).read_text(encoding="utf-8").count(mutation.old) == 1
    assert mutation.new != mutation.old
    assert all((ROOT / test.partition("::")[0]).is_file() for test in mutation.tests)
