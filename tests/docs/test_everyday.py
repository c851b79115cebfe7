"""docs/howto/everyday.md: three tasks, each in 15 lines or fewer; the blocks run with all others."""

import re

from places import HOWTO

MOST = 15


def test_each_task_is_short():
    page = (HOWTO / "everyday.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```python\n(.*?)^```", page, flags=re.MULTILINE | re.DOTALL)
    assert len(blocks) == 3
    assert all(len([line for line in block.splitlines() if line.strip()]) <= MOST for block in blocks)
