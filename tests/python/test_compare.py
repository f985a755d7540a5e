# SPDX-License-Identifier: MIT
"""Two scans of one room: what became of each thing."""
import numpy as np
import pytest

import topple


@pytest.fixture(scope='module')
def parsed(result, tmp_path_factory):
    folder = tmp_path_factory.mktemp('compared') / 'out'
    result.write(folder)
    return folder


def test_a_result_is_as_it_is(parsed, result):
    found = topple.compare(parsed, str(parsed))
    assert found.alignment.same_frame and found.alignment.agreeing > 0.99
    assert np.allclose(found.alignment.a_from_b, np.eye(4), atol=1e-3)
    movable = [o.id for o in result.objects if not o.grounded]
    assert [thing.a for thing in found.things] == movable == [thing.b for thing in found.things]
    assert {thing.became for thing in found.things} <= {'same'}
    assert not any(thing.less_safe or thing.safer or thing.stands_otherwise for thing in found.things)


def test_what_is_no_output_is_refused(parsed, tmp_path):
    with pytest.raises(topple.Error, match='nowhere') as raised:
        topple.compare(parsed, tmp_path / 'nowhere')
    assert raised.value.kind == 'input'
    with pytest.raises(topple.Error, match='two folders') as raised:
        topple.compare(parsed, 7)
    assert raised.value.kind == 'usage'
