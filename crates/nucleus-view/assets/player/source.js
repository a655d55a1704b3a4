// Where the bytes of a cache come from: the server that served this page, or a file on this machine.
// A source has a name, a size and `read(offset, length)`.

import { Trouble } from "./trouble.js";

export class UrlSource {
  // The cache that the server has, or null if there is no server or no cache.
  static async find(url) {
    try {
      const head = await fetch(url, { method: "HEAD" });
      return head.ok ? new UrlSource(url, head.headers) : null;
    } catch {
      return null;
    }
  }

  constructor(url, headers) {
    this.url = url;
    this.size = Number(headers.get("Content-Length"));
    const name = /filename\*=UTF-8''(.*)$/.exec(headers.get("Content-Disposition") ?? "");
    this.name = name ? decodeURIComponent(name[1]) : url;
  }

  async read(offset, length) {
    const Range = `bytes=${offset}-${offset + length - 1}`;
    const answer = await fetch(this.url, { headers: { Range } }).catch(() => null);
    if (!answer) {
      throw new Trouble("The server does not answer any more.", "Was the player stopped?");
    }
    const bytes = new Uint8Array(await answer.arrayBuffer());
    if (answer.status !== 206 || bytes.length !== length) {
      throw new Trouble("The server did not send what was asked for.", "Did the file change? Load the page again.");
    }
    return bytes;
  }
}

export class FileSource {
  constructor(file) {
    this.file = file;
    this.size = file.size;
    this.name = file.name;
  }

  async read(offset, length) {
    try {
      return new Uint8Array(await this.file.slice(offset, offset + length).arrayBuffer());
    } catch {
      throw new Trouble("The file cannot be read any more.", "Was it moved or written anew? Open it again.");
    }
  }
}
