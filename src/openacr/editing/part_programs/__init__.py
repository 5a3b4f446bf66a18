"""Part programs in an editor, in both dialects of RS-274."""
