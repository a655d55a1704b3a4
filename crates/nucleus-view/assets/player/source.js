// Sources of a cache: the server of this page, or a file on this machine. A source has a name, a size in bytes and
// `read(offset, length)`. Also the errors that the page shows.

// An error for the user, with a hint at the remedy.
export class PlayerError extends Error {
  constructor(message, hint = "") {
    super(message);
    this.hint = hint;
  }
}

// Bytes of a run that a newer one has replaced.
export class ReplacedRun extends PlayerError {
  constructor() {
    super("The scene is solved again.");
  }
}

export class DamagedFrame extends PlayerError {
  constructor() {
    super("A frame of the file is damaged.", "The other frames can still be shown.");
  }
}

export class UrlSource {
  // The cache of the server, or null if there is no server or no cache. A cache that is no longer there is an error.
  static async find(url) {
    const head = await fetch(url, { method: "HEAD" }).catch(() => null);
    if (head?.status === 410) {
      throw new PlayerError("The cache is no longer there.", "The file was moved or deleted. Start `nucleus play` again.");
    }
    return head?.status === 200 ? new UrlSource(url, head.headers) : null;
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
      throw new PlayerError("The server no longer responds.", "Start `nucleus play` again.");
    }
    if (answer.status === 204) {
      throw new ReplacedRun();
    }
    const bytes = new Uint8Array(await answer.arrayBuffer());
    if (answer.status !== 206 || bytes.length !== length) {
      throw new PlayerError("The server sent other bytes than requested.", "The file may have changed. Load the page again.");
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
      throw new PlayerError("The file can no longer be read.", "It was moved or replaced. Open it again.");
    }
  }
}
