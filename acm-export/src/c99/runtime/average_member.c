    {
        double own[@WIDTH];
        for (int i = 0; i < @WIDTH; ++i) {
            own[i] = in[PLACE_@K[i]];
        }
        result = m@K_take(&s->member@K, own, elapsed, seen, &one);
        if (result != $WHOLE_OK) {
@RESTART            return result;
        }
        add(&sum, &one, WEIGHT[@M]);
@HISTORY    }
