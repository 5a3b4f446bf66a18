"""Time of a virtual card that runs in both directions: keyframes, inputs, branches."""

from openacr.timeline.bookmarks import Bookmark, Bookmarks, Kind
from openacr.timeline.branch import Branch
from openacr.timeline.course import Course
from openacr.timeline.moment import Moment
from openacr.timeline.timeline import Timeline

__all__ = ["Bookmark", "Bookmarks", "Branch", "Course", "Kind", "Moment", "Timeline"]
