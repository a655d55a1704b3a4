// Something that the person at the screen should read, with a hint at what to do.
export class Trouble extends Error {
  constructor(message, hint = "") {
    super(message);
    this.hint = hint;
  }
}
