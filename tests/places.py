"""Where the tests find what belongs to the project beside them."""

from pathlib import Path

TESTS = Path(__file__).parent
ROOT = TESTS.parent
DATA, DOCS, EXAMPLES = TESTS / "data", ROOT / "docs", ROOT / "examples"
HOWTO = DOCS / "howto"
