"""The panel: AcroMill's screens in a browser, for one machine.

`control` owns the machine in a thread of its own, `commands` are what operators can do,
`wire` are the frames to and from browsers, `server` is HTTP and the WebSocket.
"""
