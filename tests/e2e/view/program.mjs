// SPDX-License-Identifier: MIT
// The program under test: that of the build folder, or of HAPTICD_BIN.
import {spawn} from 'node:child_process';
import {mkdtempSync, rmSync} from 'node:fs';
import {dirname, join} from 'node:path';
import {fileURLToPath} from 'node:url';

export const root = join(dirname(fileURLToPath(import.meta.url)), '..', '..', '..');
export const hapticd = process.env.HAPTICD_BIN ?? join(root, 'build', 'release', 'bin', 'hapticd');
export const scenes = (name) => join(root, 'config', 'scenes', `${name}.yaml`);

/** Waits until `look` gives something, at most `seconds`. */
export async function until(look, seconds = 20, what = 'what was waited for') {
  for (const end = Date.now() + 1000 * seconds; Date.now() < end; await new Promise((r) => setTimeout(r, 20))) {
    const found = await look();
    if (found) return found;
  }
  throw new Error(`${what} did not come within ${seconds} s`);
}

/** A program whose output is kept; end() ends it and waits. */
export class Program {
  constructor(args, env = {}, program = hapticd) {
    this.output = '';
    this.child = spawn(program, args, {env: {...process.env, ...env}, stdio: ['ignore', 'pipe', 'pipe']});
    for (const pipe of [this.child.stdout, this.child.stderr]) pipe.on('data', (data) => { this.output += data; });
    this.ended = new Promise((resolve) => this.child.on('close', (code) => resolve(code)));
  }

  /** What the output holds once it matches. */
  async says(pattern, seconds = 30) {
    return until(() => this.output.match(pattern), seconds, `${pattern} in\n${this.output}\n`);
  }

  async end(signal = 'SIGTERM') {
    if (this.child.exitCode === null) this.child.kill(signal);
    return this.ended;
  }
}

/** A folder for the sockets and files of one test. */
export class Sandbox {
  constructor() {
    this.folder = mkdtempSync(join(process.env.HAPTICD_TEST_MEMORY ?? '/dev/shm', 'hapticd-view-test-'));
    this.env = {RUNTIME_DIRECTORY: this.folder, STATE_DIRECTORY: this.folder, XDG_STATE_HOME: this.folder};
    this.programs = [];
  }

  start(args, what = hapticd) {
    const program = new Program(args, this.env, what);
    this.programs.push(program);
    return program;
  }

  /** A daemon with a page; resolves with both and the page's address. */
  async show(scene, {args = [], view = ['--view', '--no-open']} = {}) {
    const daemon = this.start(['run', scene, '--name', 'test', '--allow-non-rt', ...view, ...args]);
    const [url] = await daemon.says(/http:\/\/127\.0\.0\.1:\d+\/\?token=[0-9a-f]{32}/);
    return {daemon, url};
  }

  async close() {
    for (const program of this.programs.reverse()) await program.end();
    rmSync(this.folder, {recursive: true, force: true});
  }
}

/** Runs `use(sandbox)` with programs and files of its own. */
export async function sandboxed(use) {
  const sandbox = new Sandbox();
  try {
    return await use(sandbox);
  } finally {
    await sandbox.close();
  }
}
