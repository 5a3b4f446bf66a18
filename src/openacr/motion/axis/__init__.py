"""One axis: attachments, feedback, settings, filters, drive."""
