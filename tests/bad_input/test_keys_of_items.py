"""All keys that an item of a model file lacks or misspells are named at once, of every kind there is."""

import pytest

import ancf
from ancf.model.file import parse_study
from ancf.model.kinds import GROUPS
from registered import POINTS, STAGE, table_of

KINDS = [pytest.param(group, kind, id=kind.word) for group, kinds in GROUPS.items() for kind in kinds]


def required(kind):
    """Keys that must be given, with any values: none is looked at before all are there."""
    table = table_of(kind, POINTS[: len(kind.keys or kind.ends)])
    fields = kind.entry().model_fields
    return table, [key for key in table if key != "type" and fields[key].is_required()]


def said(group, tables):
    with pytest.raises(ancf.ModelError) as caught:
        parse_study(STAGE | {group: tables})
    return str(caught.value)


@pytest.mark.parametrize(("group", "kind"), KINDS)
class TestKeys:
    def test_missing(self, group, kind):
        table, keys = required(kind)
        told = said(group, [{"type": kind.word}])
        assert all(f"{group}[0].{key}: is missing" in told for key in keys)
        assert told.count("is missing") == len(keys) > 0
        for key in keys:  # and each alone
            some = {name: value for name, value in table.items() if name != key}
            assert f"{group}[0].{key}: is missing" in said(group, [some])

    def test_misspelled(self, group, kind):
        """Two letters of long names exchanged; of short ones nothing tells what they were."""
        table, keys = required(kind)
        wrong = {key: key[0] + key[2] + key[1] + key[3:] for key in keys if len(key) > 4}
        if not wrong:
            pytest.skip("its keys are short")
        told = said(group, [{wrong.get(key, key): value for key, value in table.items()}])
        for key, typo in wrong.items():
            assert f"{group}[0].{key}: is missing" in told
            line = next(line for line in told.splitlines() if f"{group}[0].{typo}: unknown key" in line)
            assert line.endswith(f'(did you mean "{key}"?)')

    def test_of_two_items(self, group, kind):
        keys = required(kind)[1]
        told = said(group, [{"type": kind.word}, {"type": kind.word}])
        assert all(f"{group}[{k}].{keys[0]}: is missing" in told for k in (0, 1))
