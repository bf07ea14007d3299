/* A program that does what no core can, an illegal instruction: a test that this ends it, and as a fault. */
int main(void)
{
    __builtin_trap();
}
