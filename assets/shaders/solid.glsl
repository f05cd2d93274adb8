in vec3 position;   // of a cube or cylinder −1 … 1
in vec4 place;      // per solid: centre; w: 1 if round
in vec4 half_size;  // per solid
in vec4 turn;       // per solid: cosine and sine of the heading, how it rises along its own z

vec3 placed() {
    vec3 v = position * half_size.xyz;
    return place.xyz + vec3(turn.x * v.x + turn.y * v.z, v.y + turn.z * v.z, turn.x * v.z - turn.y * v.x);
}
