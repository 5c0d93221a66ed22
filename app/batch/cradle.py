"""The process that workers are forked from: it imports what each of them needs, once for all.

It has one thread, and calls nothing that is compiled and nothing of OpenGL: what it imported can
be forked safely. It ends with the batch, and its workers with it.
"""

import gc
import os
import select
import signal
import socket
import traceback
from typing import NamedTuple, NoReturn

from app.batch import worker

PIPES = 4
"""What a birth is asked for with: jobs, answers, errors, and the line that tells of the worker."""
NUMBER = 8
"""Bytes of a number on that line: first the worker's process, at its end how it ended."""


class _Living(NamedTuple):
    process: int
    line: int


def main() -> None:
    """Bear workers until the other side has gone."""
    worker.detach()
    worker.prepare()
    # What is there stays: looking it through would copy, in every worker, the pages it lies in.
    gc.freeze()
    asked = socket.socket(fileno=os.dup(0))
    bell, ringer = os.pipe()
    for end in (bell, ringer):
        os.set_blocking(end, False)
    signal.signal(signal.SIGCHLD, lambda *_: None)
    signal.set_wakeup_fd(ringer)
    living: list[_Living] = []
    while True:
        ready, _, _ = select.select([asked.fileno(), bell], [], [])
        if bell in ready:
            os.read(bell, select.PIPE_BUF)
            living = [one for one in living if not _told_its_end(one)]
        if asked.fileno() in ready:
            _, pipes, _, _ = socket.recv_fds(asked, 1, PIPES)
            if not pipes:
                return
            living.append(_born(pipes, [asked.fileno(), bell, ringer], living))


def _told_its_end(one: _Living) -> bool:
    ended, status = os.waitpid(one.process, os.WNOHANG)
    if ended:
        _tell(one.line, status)
        os.close(one.line)
    return bool(ended)


def _born(pipes: list[int], own: list[int], living: list[_Living]) -> _Living:
    *standard, line = pipes
    process = os.fork()
    if process == 0:
        _work(standard, [*own, line, *(one.line for one in living)])
    for end in standard:
        os.close(end)
    _tell(line, process)
    return _Living(process, line)


def _work(standard: list[int], foreign: list[int]) -> NoReturn:
    """Be a worker, and never return to what the cradle does."""
    code = 1
    try:
        signal.set_wakeup_fd(-1)
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        for end in foreign:
            os.close(end)
        for place, end in enumerate(standard):
            os.dup2(end, place)
            os.close(end)
        worker.main()
        code = 0
    except BaseException:
        traceback.print_exc()
    finally:
        os._exit(code)


def _tell(line: int, number: int) -> None:
    try:
        os.write(line, number.to_bytes(NUMBER, "little"))
    except BrokenPipeError:  # nobody wants to know any more
        return


if __name__ == "__main__":
    main()
