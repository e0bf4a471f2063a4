"""Pages quote the files of examples that tests/check-clusters runs."""
import pathlib
import re
import unittest

docs = pathlib.Path(__file__).resolve().parent.parent.parent / "docs"


class Clusters(unittest.TestCase):
    def test_are_quoted_as_they_are(self):
        blocks = re.findall(r"```\w+\n(.*?)```", (docs / "clusters.md").read_text(), flags=re.S)
        for file in (docs / "clusters").iterdir():
            self.assertIn(file.read_text(), blocks)


if __name__ == "__main__":
    unittest.main()
