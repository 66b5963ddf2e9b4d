// SPDX-License-Identifier: MIT
// Node before 22.15 unpacks no zstd by itself: the tool does.
import {execFileSync} from 'node:child_process';
import * as zlib from 'node:zlib';

export function decompress(bytes, size) {
  const out = zlib.zstdDecompressSync ? zlib.zstdDecompressSync(bytes) : execFileSync('zstd', ['-dcq'], {input: bytes, maxBuffer: Number(size) + 1024});
  return new Uint8Array(out);
}
