#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""topple view: what it serves, what it does not, and how it ends. view_test.py PROGRAM"""
import contextlib
import http.client
import os
import pathlib
import re
import signal
import socket
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request


def make_output(program, folder):
    """The output of a parse of a floor with a box on it."""
    lines = [f'{x / 50} {y / 50} 0' for x in range(100) for y in range(100)]
    for u in range(20):
        for v in range(20):
            a, b = 0.8 + u / 50, v / 50
            lines += [f'{a} {0.8 + b} 0.4', f'{a} 0.8 {b}', f'{a} 1.2 {b}', f'0.8 {a} {b}', f'1.2 {a} {b}']
    (folder / 'scan.xyz').write_text('\n'.join(lines))
    subprocess.run([program, 'parse', folder / 'scan.xyz', '-o', folder / 'out', '--backend', 'native', '--quiet'], check=True,
                   stdout=subprocess.DEVNULL)
    return folder / 'out'


@contextlib.contextmanager
def served(program, out, *options):
    """The port, and the process, which is stopped at the end."""
    process = subprocess.Popen([program, 'view', out, '--no-browser', *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        line = process.stdout.readline()
        port = re.search(r'http://127\.0\.0\.1:(\d+)/', line)
        assert port, (line, process.stderr.read())
        yield int(port[1]), process
    finally:
        if process.poll() is None:
            process.kill()
        process.communicate()


def ask(port, path, method='GET', host=None, **headers):
    """The status and the body; the path as it is, with what urllib would clean up."""
    connection = http.client.HTTPConnection('127.0.0.1', port, timeout=20)
    connection.putrequest(method, path, skip_host=True)
    connection.putheader('Host', host or f'127.0.0.1:{port}')
    for name, value in headers.items():
        connection.putheader(name, value)
    connection.endheaders()
    answer = connection.getresponse()
    body = answer.read()
    connection.close()
    return answer.status, body, answer.getheader('Content-Type')


def serves_the_files(program, out):
    with served(program, out) as (port, _):
        with urllib.request.urlopen(f'http://127.0.0.1:{port}/', timeout=20) as answer:
            assert answer.read() == (out / 'report.html').read_bytes() and answer.headers['Content-Type'].startswith('text/html')
        for name in os.listdir(out):
            status, body, _ = ask(port, f'/{name}')
            assert status == 200 and body == (out / name).read_bytes(), name
        assert ask(port, '/scene.json', host=f'localhost:{port}')[2] == 'application/json'
        assert ask(port, '/scene.json', 'HEAD')[:2] == (200, b'')
        assert ask(port, '/scene%2Ejson?a=b')[1] == (out / 'scene.json').read_bytes()
        connection = http.client.HTTPConnection('127.0.0.1', port, timeout=20)  # several over one
        for name in ('scene.json', 'missing', 'report.html'):
            connection.request('GET', f'/{name}')
            answer = connection.getresponse()
            body = answer.read()
            assert (answer.status, body) == (200, (out / name).read_bytes()) if name != 'missing' else answer.status == 404
        connection.close()


def serves_nothing_else(program, out):
    (out.parent / 'secret').write_text('secret')
    before = sorted(os.listdir(out))
    os.symlink(out.parent / 'secret', out / 'link')
    os.mkdir(out / 'folder')
    (out / 'folder' / 'inner').write_text('secret')
    (out / '.hidden').write_text('secret')
    os.mkfifo(out / 'pipe')
    try:
        with served(program, out) as (port, _):
            for path in ('/../secret', '/%2e%2e/secret', '/..%2fsecret', '/..%5csecret', '//etc/passwd', '/%2fetc%2fpasswd', '/link', '/folder',
                         '/folder/inner', '/.hidden', '/pipe', '/..', '/.', '/scene.json%00', '/scene.json/', '/%zz', '/%', '*', f'/{"a" * 5000}', '/missing'):
                status, body, _ = ask(port, path)
                assert status in (400, 404) and b'secret' not in body, (path, status, body)
            assert ask(port, '/scene.json', host='evil.example')[0] == 403
            assert ask(port, '/scene.json', host=f'evil.example:{port}')[0] == 403
            for method in ('POST', 'PUT', 'DELETE'):
                status = ask(port, '/scene.json', method, **{'Content-Length': '0'})[0]
                assert status == 405, (method, status)
            with socket.create_connection(('127.0.0.1', port), timeout=20) as wild:
                wild.sendall(b'\x00\xff' * 50 + b'\r\n\r\n')
                wild.recv(100)
            assert ask(port, '/')[0] == 200  # it still serves
            with open('/proc/net/tcp') as table:  # where it listens: on this machine's own address
                listens = [line.split()[1] for line in table if line.split()[3] == '0A']
            assert f'0100007F:{port:04X}' in listens and f'00000000:{port:04X}' not in listens
    finally:
        os.remove(out / 'pipe')
        os.remove(out / 'link')
        os.remove(out / '.hidden')
        os.remove(out / 'folder' / 'inner')
        os.rmdir(out / 'folder')
    assert sorted(os.listdir(out)) == before


def next_event(stream):
    """The time that the next event tells, in milliseconds."""
    for line in stream:
        if line.startswith(b'data: '):
            return int(line[6:])
    raise AssertionError('the events have ended')


def tells_of_newer_outputs(program, out):
    with served(program, out) as (port, _), contextlib.ExitStack() as opened:
        address = f'http://127.0.0.1:{port}/events'
        events = opened.enter_context(urllib.request.urlopen(address, timeout=60))
        assert events.headers['Content-Type'] == 'text/event-stream'
        first = next_event(events)
        assert abs(first / 1000 - time.time()) < 60
        before = (out / 'report.html').read_bytes()
        subprocess.run([program, 'parse', out.parent / 'scan.xyz', '-o', out, '--title', 'Another title', '--backend', 'native', '--quiet'],
                       check=True)
        assert next_event(events) > first
        assert ask(port, '/')[1] == (out / 'report.html').read_bytes() != before
        # What is no output is not served in its place, and the last one is until there is another.
        aside, foreign = out.parent / 'aside', out.parent / 'foreign'
        foreign.mkdir()
        (foreign / 'report.html').write_text('foreign')
        os.rename(out, aside)
        os.rename(foreign, out)
        time.sleep(1)
        assert ask(port, '/')[1] == (aside / 'report.html').read_bytes()
        (out / 'report.html').unlink()
        out.rmdir()
        os.rename(aside, out)
        assert ask(port, '/events', 'HEAD')[0] == 404 and ask(port, '/events', host='evil.example')[0] == 403
        for _ in range(31):
            opened.enter_context(urllib.request.urlopen(address, timeout=60))
        assert ask(port, '/events')[0] == 503 and ask(port, '/')[0] == 200


def ends_by_signals(program, out):
    for wanted in (signal.SIGINT, signal.SIGTERM):
        with served(program, out) as (port, process):
            idle = socket.create_connection(('127.0.0.1', port))  # which keeps nobody
            process.send_signal(wanted)
            assert process.wait(timeout=20) == 0 and process.stderr.read() == ''
            idle.close()


def says_what_is_wrong(program, out):
    def fails(code, *arguments):
        done = subprocess.run([program, 'view', *arguments], capture_output=True, text=True, timeout=60)
        assert done.returncode == code and done.stderr.count('\n') == 1 and done.stdout == '', done
        return done.stderr

    with served(program, out) as (port, _):
        assert f'--port {port}' in fails(2, out, '--no-browser', '--port', str(port))
    assert 'scene.json' in fails(1, out.parent, '--no-browser')
    assert 'missing' in fails(1, out.parent / 'missing', '--no-browser')
    for port in ('0', '65536', '-1', 'x'):
        assert '--port' in fails(2, out, '--no-browser', '--port', port)


def main():
    program = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as work:
        out = make_output(program, pathlib.Path(work))
        for check in (serves_the_files, serves_nothing_else, tells_of_newer_outputs, ends_by_signals, says_what_is_wrong):
            check(program, out)
            print(check.__name__)


if __name__ == '__main__':
    main()
