// Something that the person at the screen should read, with a hint at what to do.
export class Trouble extends Error {
  constructor(message, hint = "") {
    super(message);
    this.hint = hint;
  }
}

export class Damage extends Trouble {
  constructor() {
    super("A frame of the file is damaged.", "The frames before and after it can still be shown.");
  }
}
