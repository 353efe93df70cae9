# SPDX-License-Identifier: GPL-3.0-or-later
"""Joins the core's progress callback, and loops of the plugin, to a QgsProcessingFeedback."""


class Stopped(Exception):
    """The user has cancelled."""


def until_cancelled(items, feedback, every=100):
    """The items one by one; raises Stopped once the user has cancelled, looked up `every` so many items."""
    for number, item in enumerate(items):
        if number % every == 0 and feedback.isCanceled():
            raise Stopped
        yield item


class Progress:
    """A callback for the core: shows the fraction done, and answers False once the user has cancelled.

    `first` and `last` are the part of the whole bar, in per cent, that this job takes.
    """

    def __init__(self, feedback, first=0.0, last=100.0):
        self.feedback = feedback
        self.first = first
        self.last = last

    def __call__(self, fraction):
        self.feedback.setProgress(self.first + (self.last - self.first) * fraction)
        return not self.feedback.isCanceled()
