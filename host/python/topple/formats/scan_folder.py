# SPDX-License-Identifier: MIT
"""The one way to open what a scan names."""
import errno
import os
import stat

from .errors import wrong


class ScanFolder:
    """Files by their names with / below a folder: regular ones, and by way of no link, so that a scan has nothing read but itself. The
    folder itself may be a link, as the user named it."""

    def __init__(self, path):
        self.path = path

    def has(self, name):
        """Whether there is such a file, or a link, of which open() tells."""
        self._parts(name)
        try:
            mode = os.lstat(self.path / name).st_mode
        except OSError:
            return False
        return stat.S_ISREG(mode) or stat.S_ISLNK(mode)

    def names(self):
        """Of all files and links."""
        return [os.path.relpath(os.path.join(place, name), self.path).replace(os.sep, '/')
                for place, folders, names in os.walk(self.path) for name in names + folders
                if self.has(os.path.relpath(os.path.join(place, name), self.path))]

    def open(self, name):
        """A file, to read bytes from."""
        *folders, last = self._parts(name)
        at = os.open(self.path, os.O_PATH | os.O_DIRECTORY | os.O_CLOEXEC)
        try:
            for folder in folders:
                inner = os.open(folder, os.O_PATH | os.O_DIRECTORY | os.O_NOFOLLOW | os.O_CLOEXEC, dir_fd=at)
                os.close(at)
                at = inner
            # Of a pipe that nobody writes to, opening would wait.
            found = os.open(last, os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC | os.O_NOCTTY, dir_fd=at)
        except OSError as error:
            if error.errno in (errno.ELOOP, errno.ENOTDIR):
                raise wrong(self.path / name, 'is a link, or lies behind one; of a scan only files in its own folder are read: copy it there') from None
            raise wrong(self.path / name, error.strerror or str(error)) from None
        finally:
            os.close(at)
        return _file(found, self.path / name)

    def read(self, name):
        with self.open(name) as file:
            return file.read()

    def _parts(self, name):
        parts = name.split('/')
        odd = '\0' in name or any('\ud800' <= c <= '\udfff' for c in name)
        if odd or any(part in ('', '.', '..') for part in parts):
            raise wrong(self.path, f'names a file "{name}", which does not lie in its folder; name one that does')
        return parts


def regular(path):
    """A file that a user named, by way of links or not, to read bytes from."""
    return _file(os.open(path, os.O_RDONLY | os.O_NONBLOCK | os.O_CLOEXEC | os.O_NOCTTY), path)


def _file(descriptor, path):
    if not stat.S_ISREG(os.fstat(descriptor).st_mode):
        os.close(descriptor)
        raise wrong(path, 'is no regular file')
    return open(descriptor, 'rb')
