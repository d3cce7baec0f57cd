"""What may stand between a client and its daemon: lines that break, stand still, or lead to a server of another version."""
import concurrent.futures
import contextlib
import socket
import threading

import grpc


@contextlib.contextmanager
def cutting_proxy(address, cut_after, stall_after=None):
    """The address of a line to another one. Its first connection breaks once so many bytes came back (None: never), and takes no
    more than `stall_after` bytes (None: all)."""
    host, port = address.rsplit(":", 1)
    listener = socket.create_server(("127.0.0.1", 0))
    if stall_after is not None:  # the sender's own buffer fills, too
        listener.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
    stopping = threading.Event()
    is_first = True

    def carry(source, target, limit, broken):
        carried = 0
        try:
            while data := source.recv(4096):
                carried += len(data)
                if limit is not None and carried > limit:
                    broken(data)
                    return
                target.sendall(data)
        except OSError:
            pass
        for end in (source, target):
            with contextlib.suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)

    def cut(client, server):
        def broken(_):
            client.close()
            server.close()

        return broken

    def serve():
        nonlocal is_first
        while not stopping.is_set():
            try:
                client, _ = listener.accept()
            except OSError:
                return
            server = socket.create_connection((host, int(port)))
            up, down = (stall_after, cut_after) if is_first else (None, None)
            is_first = False
            threading.Thread(
                target=carry, args=(client, server, up, lambda _: stopping.wait()), daemon=True
            ).start()
            threading.Thread(
                target=carry, args=(server, client, down, cut(client, server)), daemon=True
            ).start()

    threading.Thread(target=serve, daemon=True).start()
    try:
        yield f"127.0.0.1:{listener.getsockname()[1]}"
    finally:
        stopping.set()
        listener.close()


@contextlib.contextmanager
def version_server(version):
    """The address of a server that says this version of itself, or with "" none, and knows nothing else."""

    class Handler(grpc.GenericRpcHandler):
        def service(self, details):
            if not version or not details.method.endswith("/GetServerInfo"):
                return None
            answer = b"\x0a" + bytes([len(version)]) + version.encode()  # field 1, a text
            return grpc.unary_unary_rpc_method_handler(lambda request, context: answer)

    server = grpc.server(concurrent.futures.ThreadPoolExecutor(max_workers=2))
    server.add_generic_rpc_handlers((Handler(),))
    port = server.add_insecure_port("127.0.0.1:0")
    server.start()
    try:
        yield f"127.0.0.1:{port}"
    finally:
        server.stop(0).wait()
