"""Documents one after the other in one answer, as MTConnect streams them."""

BOUNDARY = "openacr-mtconnect"
XML = "text/xml"
MULTIPART = f"multipart/x-mixed-replace; boundary={BOUNDARY}"
END = f"--{BOUNDARY}--\r\n".encode()


def part(body: bytes) -> bytes:
    """A document as a part of a stream."""
    head = f"--{BOUNDARY}\r\nContent-type: {XML}\r\nContent-length: {len(body)}\r\n\r\n"
    return head.encode() + body + b"\r\n"
