// Floats compared by their words, as compilers may take floats for finite and zeros for alike.

// -0 as +0, so that words are equal where floats are; but for NaN, which equals nothing.
fn without_sign_of_zero(word: u32) -> u32 {
    return select(word, 0u, (word & 0x7fffffffu) == 0u);
}
