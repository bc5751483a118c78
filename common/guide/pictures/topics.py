"""Prints the topics that `deckflex live` offers, with what one message of each area's solution says.

Usage: topics.py [URL]; needs websockets and protobuf of PyPI. Exit code 1 if a solution cannot be decoded.
"""

import asyncio
import base64
import json
import struct
import sys

import websockets
from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

ARCMIN = 3437.746770784939  # a radian


def decoder(schema_name, schema):
    """A class for messages of a schema, which is a set of file descriptors."""
    files = descriptor_pb2.FileDescriptorSet.FromString(base64.b64decode(schema))
    pool = descriptor_pool.DescriptorPool()
    for file in files.file:
        pool.Add(file)
    return message_factory.GetMessageClass(pool.FindMessageTypeByName(schema_name))


async def topics(url):
    # solutions are a kilobyte each, and the first lines hold all schemas
    async with websockets.connect(url, subprotocols=["foxglove.sdk.v1"], max_size=None) as socket:
        server, channels, wanted, said = None, {}, {}, {}
        while len(said) < len(wanted) or not channels:
            frame = await asyncio.wait_for(socket.recv(), 20)
            if isinstance(frame, bytes):
                opcode, number, _ = struct.unpack_from("<BIQ", frame)
                if opcode == 1 and number in wanted:
                    said[wanted[number]["topic"]] = decode(wanted[number], frame[13:])
                continue
            told = json.loads(frame)
            if told["op"] == "serverInfo":
                server = told["name"]
            elif told["op"] == "advertise":
                channels |= {channel["id"]: channel for channel in told["channels"]}
                new = [c for c in told["channels"] if c["topic"].endswith("/solution")]
                wanted |= {c["id"]: c for c in new}
                subscriptions = [{"id": c["id"], "channelId": c["id"]} for c in new]
                if new:
                    await socket.send(json.dumps({"op": "subscribe", "subscriptions": subscriptions}))
    return server, list(channels.values()), said


def decode(channel, data):
    solution = decoder(channel["schemaName"], channel["schema"]).FromString(data)
    phi = ", ".join(f"{ARCMIN * x:+.2f}" for x in solution.phi)
    return solution, f"t {solution.header.time_ns / 1e9:.2f} s, valid {solution.valid}, phi {phi} arcmin"


def main():
    url = sys.argv[1] if len(sys.argv) > 1 else "ws://127.0.0.1:8765"
    server, channels, said = asyncio.run(topics(url))
    print(f"server {server}, {len(channels)} topics")
    width = max(len(channel["topic"]) for channel in channels)
    for channel in sorted(channels, key=lambda channel: channel["topic"]):
        print(f"{channel['topic']:<{width}}  {channel['encoding']}  {channel['schemaName']}")
    for topic, (_, words) in sorted(said.items()):
        print(f"{topic}: {words}")


if __name__ == "__main__":
    main()
