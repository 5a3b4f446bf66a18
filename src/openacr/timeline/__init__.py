"""Time of a virtual card that runs in both directions: keyframes, inputs, branches."""

from openacr.timeline.branch import Branch
from openacr.timeline.moment import Moment
from openacr.timeline.timeline import Timeline

__all__ = ["Branch", "Moment", "Timeline"]
