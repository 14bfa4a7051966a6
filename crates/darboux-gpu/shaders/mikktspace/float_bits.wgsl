// Compares floats by their bits, because compilers may assume that floats are finite and ignore the signs of zeros.

// Turns -0 into +0, so that the words are equal if the floats are. NaN is the exception.
fn without_sign_of_zero(word: u32) -> u32 {
    return select(word, 0u, (word & 0x7fffffffu) == 0u);
}
