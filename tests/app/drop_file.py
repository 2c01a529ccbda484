# Copyright (c) 2026, the gpo-inspector authors
# SPDX-License-Identifier: BSD-3-Clause
"""Drops a file on an X11 window as a file manager does (XDND, version 5):
    python3 drop_file.py WINDOW FILE
Exits with 1 if the window does not accept it."""
import pathlib
import sys
import time

from Xlib import X, display
from Xlib.protocol import event

kSeconds = 30


def main(window_id, file):
    dpy = display.Display()
    atom = dpy.intern_atom
    target = dpy.create_resource_object("window", window_id)
    source = dpy.screen().root.create_window(0, 0, 1, 1, 0, dpy.screen().root_depth)
    uris = (pathlib.Path(file).resolve().as_uri() + "\r\n").encode()

    def send(name, *numbers):
        data = (32, [source.id, *numbers, *[0] * (4 - len(numbers))])
        target.send_event(event.ClientMessage(window=target, client_type=atom(name), data=data))
        dpy.flush()

    def hand_over(request):
        request.requestor.change_property(request.property, request.target, 8, uris)
        request.requestor.send_event(
            event.SelectionNotify(
                time=request.time,
                requestor=request.requestor,
                selection=request.selection,
                target=request.target,
                property=request.property,
            )
        )
        dpy.flush()

    def answer(name):
        """Waits for the answer of the window, which may request the file meanwhile."""
        end = time.monotonic() + kSeconds
        while time.monotonic() < end:
            if not dpy.pending_events():
                time.sleep(0.01)
                continue
            message = dpy.next_event()
            if message.type == X.SelectionRequest:
                hand_over(message)
            elif message.type == X.ClientMessage and message.client_type == atom(name):
                return message.data[1]
        sys.exit(f"no {name} within {kSeconds} s")

    source.set_selection_owner(atom("XdndSelection"), X.CurrentTime)
    place = target.translate_coords(dpy.screen().root, 0, 0)
    size = target.get_geometry()
    x, y = size.width // 2 - place.x, size.height // 2 - place.y
    send("XdndEnter", 5 << 24, atom("text/uri-list"), 0, 0)
    send("XdndPosition", 0, (x << 16) | y, X.CurrentTime, atom("XdndActionCopy"))
    if not answer("XdndStatus")[1] & 1:
        sys.exit("the window does not accept the file")
    send("XdndDrop", 0, X.CurrentTime)
    answer("XdndFinished")


main(int(sys.argv[1]), sys.argv[2])
