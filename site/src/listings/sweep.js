export function sweep(endpoints, onOverlapX) {
  const touching = new Set();

  for (const { box, isLeft } of endpoints) {
    if (isLeft) { // @enter
      for (const other of touching) { // @added
        onOverlapX(other, box); // @added @test
      } // @added
      touching.add(box);
    } else {
      touching.delete(box); // @leave
    }
  }
}
