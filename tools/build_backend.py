"""Builds a wheel of the Python module. A build backend (PEP 517) that needs only CMake and Python.

`pip install .` and `pip wheel .` call it. To call it directly:

    python3 -c 'import sys; sys.path.insert(0, "tools"); import build_backend
    print(build_backend.build_wheel("."))'

Settings (`pip --config-settings NAME=VALUE`):
    build-dir   folder for CMake's build [build/wheel]
    module      path of a built module to pack; CMake is not called
"""
import base64
import hashlib
import os
import pathlib
import re
import subprocess
import sys
import sysconfig
import zipfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
SUMMARY = 'Physically based light in rooms: pictures and illuminance'


def version():
    text = (ROOT / 'CMakeLists.txt').read_text()
    return re.search(r'project\(troffer VERSION ([0-9.]+)', text).group(1)


def tag():
    python = f'cp{sys.version_info.major}{sys.version_info.minor}'
    return f'{python}-{python}-' + re.sub(r'[-.]', '_', sysconfig.get_platform())


def build_module(folder):
    """Builds the module for this interpreter; returns its path."""
    options = {'CMAKE_BUILD_TYPE': 'Release', 'CMAKE_CXX_FLAGS_RELEASE': '-O3 -DNDEBUG',
               'CMAKE_UNITY_BUILD': 'ON', 'TROFFER_PYTHON': 'ON', 'TROFFER_MPI': 'OFF',
               'TROFFER_TESTS': 'OFF', 'TROFFER_BENCH': 'OFF',
               'Python_EXECUTABLE': sys.executable}
    subprocess.run(['cmake', '-G', 'Ninja', '-S', ROOT, '-B', folder,
                    *(f'-D{k}={v}' for k, v in options.items())], check=True)
    subprocess.run(['cmake', '--build', folder, '--target', 'troffer_module', '--parallel',
                    str(os.cpu_count() or 1)], check=True)
    return folder / 'python' / ('troffer' + sysconfig.get_config_var('EXT_SUFFIX'))


def metadata():
    return (f'Metadata-Version: 2.1\nName: troffer\nVersion: {version()}\nSummary: {SUMMARY}\n'
            'Requires-Python: >=3.9\nRequires-Dist: numpy\n'
            'Description-Content-Type: text/markdown\n\n' + (ROOT / 'README.md').read_text())


def record_of(files, record):
    rows = []
    for name, data in files.items():
        digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b'=').decode()
        rows.append(f'{name},sha256={digest},{len(data)}')
    return '\n'.join([*rows, f'{record},,']) + '\n'


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    settings = config_settings or {}
    folder = pathlib.Path(settings.get('build-dir', ROOT / 'build/wheel')).resolve()
    module = pathlib.Path(settings['module']) if 'module' in settings else build_module(folder)
    name = f'troffer-{version()}'
    info = f'{name}.dist-info'
    wheel = f'Wheel-Version: 1.0\nGenerator: troffer\nRoot-Is-Purelib: false\nTag: {tag()}\n'
    files = {module.name: module.read_bytes(),
             'troffer.pyi': (ROOT / 'src/python/troffer.pyi').read_bytes(),
             f'{info}/METADATA': metadata().encode(),
             f'{info}/LICENSE': (ROOT / 'LICENSE').read_bytes(),
             f'{info}/WHEEL': wheel.encode()}
    files[f'{info}/RECORD'] = record_of(files, f'{info}/RECORD').encode()
    path = pathlib.Path(wheel_directory) / f'{name}-{tag()}.whl'
    with zipfile.ZipFile(path, 'w', zipfile.ZIP_DEFLATED) as archive:
        for file, data in files.items():
            archive.writestr(file, data)
    return path.name


def get_requires_for_build_wheel(config_settings=None):
    return []
