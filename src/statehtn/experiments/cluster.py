"""Execute runs on the workers of a Dask cluster; scheduling, retries and failures are Dask's business.

A run travels with the text of its domain and problem, so that workers need no files of the client's, and is a process
of its own there, too. Scheduler and workers need the same version of statehtn.
"""

from __future__ import annotations

import asyncio
import signal
import uuid
import warnings
import zlib
from collections.abc import Generator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from queue import SimpleQueue
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

import statehtn
from statehtn.errors import ClusterError, UsageError
from statehtn.experiments.records import Record
from statehtn.experiments.run import Run
from statehtn.experiments.runner import Children, execute

if TYPE_CHECKING:
    from distributed import Client, Future

CONNECT_SECONDS = 5.0
RESULT_SECONDS = 10.0
"""How long to wait for a record that is there; it is not if its worker was lost after it had made it."""
OUTSTANDING = 1000
"""So many runs are with the cluster at once, at most; it keeps their problems in memory."""
RETRIES = 3
"""So often a run that was interrupted or could not be started is given to a worker again."""


@dataclass(frozen=True, slots=True)
class Parcel:
    """A run, the compressed content of its files (None for one that cannot be read), and who sends it."""

    run: Run
    domain: bytes | None
    problem: bytes | None
    version: str
    comparison: str

    @staticmethod
    def of(run: Run, comparison: str) -> Parcel:
        """Read the files of a run."""
        domain, problem = (_content(Path(name)) for name in (run.instance.domain_file, run.instance.problem_file))
        return Parcel(run, domain, problem, statehtn.__version__, comparison)


class RunInterruptedError(Exception):
    """A run has not come to an end of its own; Dask gives it to a worker again."""


class RunsOfAComparison:
    """The runs of one comparison on a worker; a Dask plugin of every worker: taken away, it ends them."""

    def __init__(self, comparison: str) -> None:
        self.name = comparison

    def setup(self, worker: Any) -> None:  # noqa: ARG002 - Dask passes it
        """Keep a list of what is running on this worker."""
        self.children = Children()

    def teardown(self, worker: Any) -> None:  # noqa: ARG002 - Dask passes it
        """End what is running."""
        self.children.stop()


def execute_on_cluster(runs: Sequence[Run], address: str) -> Generator[Record]:
    """Execute runs on a Dask cluster and yield their records as they end; close the iterator to cancel the others.

    Args:
        runs: each yields one record.
        address: of the scheduler, such as `tcp://127.0.0.1:8786`.

    Raises:
        UsageError: the package `distributed` is missing, or the address makes no sense.
        ClusterError: there is no scheduler, it is lost, or the workers cannot execute a run.
    """
    client = _connect(address)
    comparison = f"statehtn-{uuid.uuid4().hex}"
    waiting = iter(runs)
    outstanding: dict[str, tuple[Future, Run]] = {}
    ended: SimpleQueue[Future] = SimpleQueue()
    try:
        _prepare(client, address, comparison)
        while True:
            for run in islice(waiting, OUTSTANDING - len(outstanding)):
                parcel = Parcel.of(run, comparison)
                future = client.submit(execute_parcel, parcel, pure=False, retries=RETRIES, key=_key(comparison, run))
                outstanding[future.key] = future, run
                future.add_done_callback(ended.put)
            if not outstanding:
                return
            future = ended.get()
            record = _record(future, outstanding[future.key][1], address)
            if record is None:
                future.add_done_callback(ended.put)
            else:
                del outstanding[future.key]
                yield record
    finally:
        _leave(client, comparison, [future for future, _ in outstanding.values()])


def _key(comparison: str, run: Run) -> str:
    """Return a name for a run that no other has on the cluster; its first word is what Dask's dashboard shows."""
    return f"statehtn-{'-'.join(run.key)}-{comparison}"


def _connect(address: str) -> Client:
    """Return a client of the cluster.

    Raises:
        UsageError: the package `distributed` is missing, or the address makes no sense.
        ClusterError: there is no scheduler.
    """
    try:
        from distributed import Client
    except ImportError:
        raise UsageError(
            "running on a Dask cluster needs the package 'distributed': pip install 'statehtn[dask]'"
        ) from None
    try:
        # A client that cannot connect takes long to give up, and complains when it is thrown away: ask first.
        kind = asyncio.run(asyncio.wait_for(_kind_of(address), CONNECT_SECONDS))
        if kind == "Scheduler":
            with warnings.catch_warnings():  # of other packages whose versions differ
                warnings.simplefilter("ignore")
                return Client(address, timeout=CONNECT_SECONDS, set_as_default=False)
        found = f"a Dask {kind.lower()} answers"
    except (ValueError, TypeError) as error:
        raise UsageError(f"'{address}' is no address of a scheduler, such as tcp://127.0.0.1:8786: {error}") from None
    except TimeoutError:
        found = f"nothing answers within {CONNECT_SECONDS:g} s"
    except OSError as error:
        found = _one_line(error.__cause__ or error)
    except Exception:
        found = "something else answers"
    raise ClusterError(f"there is no Dask scheduler at '{address}': {found}")


async def _kind_of(address: str) -> str:
    """Ask a server of Dask what it is."""
    from distributed import Security, rpc

    async with rpc(address, connection_args=Security().get_connection_args("client")) as server:
        return str((await server.identity())["type"])


def _prepare(client: Client, address: str, comparison: str) -> None:
    """Have the scheduler and all workers, those yet to come, too, ready for the runs of a comparison.

    Raises:
        ClusterError: one is not able to.
    """
    from distributed import WorkerPlugin

    class Plugin(RunsOfAComparison, WorkerPlugin):  # type: ignore[misc]
        """Dask asks for this base class."""

    who = "the scheduler"
    try:
        client.run_on_scheduler(check_version, statehtn.__version__)
        who = "a worker"
        client.register_plugin(Plugin(comparison))
    except Exception as error:
        raise ClusterError(f"{who} of the cluster at '{address}' cannot run statehtn: {_one_line(error)}") from None
    if not client.nthreads():
        warnings.warn(f"the cluster at '{address}' has no workers yet; the runs wait for one", stacklevel=4)


def _record(future: Future, run: Run, address: str) -> Record | None:
    """Return what has come of a run that has ended; None if that is lost with its worker, and Dask executes it again.

    Raises:
        ClusterError: the cluster is lost, or the run could not be executed.
    """
    from distributed import KilledWorker
    from distributed import TimeoutError as LateError

    try:
        record: Record = future.result(timeout=RESULT_SECONDS)
    except LateError:
        if future.client.status == "running":
            return None
    except Exception:
        error = future.exception() if future.status == "error" else None
        if isinstance(error, KilledWorker):
            return Record(run, "killed", -signal.SIGKILL, 0.0, f"its workers were lost: {_one_line(error)}", None)
        if error is not None:
            name = " ".join(filter(None, run.key))
            raise ClusterError(f"the run {name} failed on the cluster: {_one_line(error)}") from None
    else:
        return record
    raise ClusterError(f"the Dask cluster at '{address}' is lost")


def _leave(client: Client, comparison: str, futures: list[Future]) -> None:
    """Cancel what is outstanding, end what is running, and leave; a cluster that is lost has nothing to cancel."""
    with suppress(Exception):
        if client.status == "running":
            client.cancel(futures, force=True)
            client.unregister_worker_plugin(comparison)
    with suppress(Exception):
        client.close(timeout=CONNECT_SECONDS)


def execute_parcel(parcel: Parcel) -> Record:
    """Execute a run on a worker, from files in a temporary folder; messages name the client's.

    Raises:
        UsageError: another version of statehtn is here.
        RunInterruptedError: the run was ended from outside, and is to be done elsewhere if it is still wanted.
        OSError: there is no place for the files, or no process can be started.
    """
    from distributed import get_worker

    check_version(parcel.version)
    children = get_worker().plugins[parcel.comparison].children
    instance = parcel.run.instance
    with TemporaryDirectory(prefix="statehtn-") as folder:
        files = {}
        for name, original, content in (
            ("domain", instance.domain_file, parcel.domain),
            ("problem", instance.problem_file, parcel.problem),
        ):
            path = Path(folder, name, Path(original).name)
            path.parent.mkdir()
            if content is not None:
                path.write_bytes(zlib.decompress(content))
            files[str(path)] = original
        domain_file, problem_file = files
        moved = replace(instance, domain_file=domain_file, problem_file=problem_file)
        record = execute(replace(parcel.run, instance=moved), children)
    if children.stopped or record.was_interrupted:
        raise RunInterruptedError("it was ended from outside")
    message = record.message
    for file, original in files.items():
        message = message.replace(file, original)
    return replace(record, run=parcel.run, message=message)


def check_version(version: str) -> None:
    """Check on another machine that it has the client's version of statehtn.

    Raises:
        UsageError: it has not.
    """
    if statehtn.__version__ != version:
        raise UsageError(f"it has version {statehtn.__version__}, the client {version}")


def _content(file: Path) -> bytes | None:
    with suppress(OSError):  # the run will say why
        return zlib.compress(file.read_bytes())
    return None


def _one_line(error: BaseException) -> str:
    return " ".join(f"{type(error).__name__}: {error}".split())
