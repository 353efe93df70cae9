# SPDX-License-Identifier: GPL-3.0-or-later
"""What the algorithms of the group Error volume have in common."""

from pathlib import Path

from ..errors import bad_input, core_errors
from ..feedback import Progress
from ..text import tr
from .base import SightboundAlgorithm


class VolumeAlgorithm(SightboundAlgorithm):
    def group(self):
        return tr("Error volume")

    def groupId(self):
        return "errorvolume"

    def read_path(self, parameters, name, context):
        """The path of a .vdb file, which must exist."""
        path = self.parameterAsFile(parameters, name, context)
        if not Path(path).is_file():
            raise bad_input(name, tr("there is no file {}.").format(path))
        self.paths[path] = name
        return path

    def open_volume(self, kind, path, name, feedback, last):
        """The volume in a file, as `kind` (a class of the core) reads it."""
        feedback.setProgressText(tr("Reading"))
        with core_errors(name):
            return kind.open(path, progress=Progress(feedback, 0.0, last))

    def save_volume(self, volume, parameters, context, feedback):
        """Writes OUTPUT; the path."""
        path = self.parameterAsFileOutput(parameters, "OUTPUT", context)
        feedback.setProgressText(tr("Writing"))
        with core_errors("OUTPUT"):
            volume.save(path)
        return path
