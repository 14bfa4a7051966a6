// 64-bit unsigned integers as two words: x is the high word, y the low word.

fn sum64(a: vec2u, b: vec2u) -> vec2u {
    let low = a.y + b.y;
    return vec2u(a.x + b.x + u32(low < a.y), low);
}

fn difference64(a: vec2u, b: vec2u) -> vec2u {
    return vec2u(a.x - b.x - u32(a.y < b.y), a.y - b.y);
}

// n < 32.
fn shift_left(a: vec2u, n: u32) -> vec2u {
    if n == 0u {
        return a;
    }
    return vec2u((a.x << n) | (a.y >> (32u - n)), a.y << n);
}

fn shift_right(a: vec2u, n: u32) -> vec2u {
    if n == 0u {
        return a;
    }
    if n < 32u {
        return vec2u(a.x >> n, (a.x << (32u - n)) | (a.y >> n));
    }
    return vec2u(0u, select(0u, a.x >> (n - 32u), n < 64u));
}

// Shifts left for positive n, which is below 32, and right for negative n.
fn shift(a: vec2u, n: i32) -> vec2u {
    if n < 0 {
        return shift_right(a, u32(-n));
    }
    return shift_left(a, u32(n));
}

// The 64-bit product of two words.
fn product_u32(a: u32, b: u32) -> vec2u {
    let low = vec2u(a & 0xffffu, b & 0xffffu);
    let high = vec2u(a >> 16u, b >> 16u);
    let inner = low.x * high.y;
    let outer = high.x * low.y;
    let middle = ((low.x * low.y) >> 16u) + (inner & 0xffffu) + (outer & 0xffffu);
    return vec2u(high.x * high.y + (inner >> 16u) + (outer >> 16u) + (middle >> 16u), a * b);
}

// a b / 2^64, too low by less than 4.
fn product64(a: vec2u, b: vec2u) -> vec2u {
    let high = product_u32(a.x, b.x);
    let middle = sum64(vec2u(0u, product_u32(a.x, b.y).x), vec2u(0u, product_u32(a.y, b.x).x));
    return sum64(high, middle);
}
