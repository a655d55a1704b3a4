// The checksum of MCAP (ISO 3309).

const CRC_TABLE = Uint32Array.from({ length: 256 }, (_, byte) => {
  let sum = byte;
  for (let bit = 0; bit < 8; bit += 1) {
    sum = sum & 1 ? (sum >>> 1) ^ 0xedb88320 : sum >>> 1;
  }
  return sum;
});

export function crc32(bytes) {
  let sum = -1;
  for (let k = 0; k < bytes.length; k += 1) {
    sum = CRC_TABLE[(sum ^ bytes[k]) & 255] ^ (sum >>> 8);
  }
  return ~sum >>> 0;
}
