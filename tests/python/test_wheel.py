"""The wheel that tools/build_backend.py packs can be installed and imported."""
import base64
import csv
import hashlib
import importlib.metadata
import pathlib
import subprocess
import sys
import tempfile
import unittest
import zipfile

import troffer

ROOT = pathlib.Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / 'tools'))
import build_backend  # noqa: E402


class Wheel(unittest.TestCase):
    def test_is_imported(self):
        self.assertEqual(build_backend.get_requires_for_build_wheel(), [])
        with tempfile.TemporaryDirectory() as folder:
            name = build_backend.build_wheel(folder, {'module': troffer.__file__})
            self.assertRegex(name, r'^troffer-[0-9.]+-cp3\d+-cp3\d+-\w+\.whl$')
            place = pathlib.Path(folder) / 'site'
            with zipfile.ZipFile(pathlib.Path(folder) / name) as wheel:
                self.assertIsNone(wheel.testzip())
                wheel.extractall(place)
            found = importlib.metadata.distributions(path=[str(place)])
            self.assertEqual([(d.metadata['Name'], d.version) for d in found],
                             [('troffer', troffer.__version__)])
            self.check_record(place)
            code = f'import sys; sys.path.insert(0, {str(place)!r}); import troffer; ' \
                   'troffer.Scene(); print(troffer.__file__)'
            told = subprocess.run([sys.executable, '-I', '-c', code], check=True,
                                  capture_output=True, text=True).stdout
            self.assertTrue(told.startswith(str(place)), told)

    def check_record(self, place):
        record = next(place.glob('*.dist-info/RECORD'))
        with open(record, newline='') as f:
            rows = list(csv.reader(f))
        self.assertEqual({r[0] for r in rows},
                         {str(p.relative_to(place)) for p in place.rglob('*') if p.is_file()})
        for file, digest, size in rows:
            if not digest:
                continue
            data = (place / file).read_bytes()
            own = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b'=').decode()
            self.assertEqual((digest, int(size)), ('sha256=' + own, len(data)))


if __name__ == '__main__':
    unittest.main()
