export function sweep(endpoints, onOverlapX) {
  const touching = new Set();

  for (const { box, begins } of endpoints) {
    if (begins) {
      for (const other of touching) {
        onOverlapX(other, box); // @test
      }
      touching.add(box); // @enter
    } else {
      touching.delete(box); // @leave
    }
  }
}
