// Whole numbers of 64 bits: high and low word.

fn sum64(a: vec2u, b: vec2u) -> vec2u {
    let low = a.y + b.y;
    return vec2u(a.x + b.x + u32(low < a.y), low);
}

fn difference64(a: vec2u, b: vec2u) -> vec2u {
    return vec2u(a.x - b.x - u32(a.y < b.y), a.y - b.y);
}

// `n` below 32.
fn shifted_left(a: vec2u, n: u32) -> vec2u {
    if n == 0u {
        return a;
    }
    return vec2u((a.x << n) | (a.y >> (32u - n)), a.y << n);
}

fn shifted_right(a: vec2u, n: u32) -> vec2u {
    if n == 0u {
        return a;
    }
    if n < 32u {
        return vec2u(a.x >> n, (a.x << (32u - n)) | (a.y >> n));
    }
    return vec2u(0u, select(0u, a.x >> (n - 32u), n < 64u));
}

// Left for a positive `n`, below 32.
fn shifted(a: vec2u, n: i32) -> vec2u {
    if n < 0 {
        return shifted_right(a, u32(-n));
    }
    return shifted_left(a, u32(n));
}

// All 64 bits of a b.
fn whole_product(a: u32, b: u32) -> vec2u {
    let low = vec2u(a & 0xffffu, b & 0xffffu);
    let high = vec2u(a >> 16u, b >> 16u);
    let inner = low.x * high.y;
    let outer = high.x * low.y;
    let middle = ((low.x * low.y) >> 16u) + (inner & 0xffffu) + (outer & 0xffffu);
    return vec2u(high.x * high.y + (inner >> 16u) + (outer >> 16u) + (middle >> 16u), a * b);
}

// a b / 2^64, too small by less than 4.
fn product64(a: vec2u, b: vec2u) -> vec2u {
    let high = whole_product(a.x, b.x);
    let middle = sum64(vec2u(0u, whole_product(a.x, b.y).x), vec2u(0u, whole_product(a.y, b.x).x));
    return sum64(high, middle);
}
